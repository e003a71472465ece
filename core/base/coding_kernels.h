#pragma once

#include <cstddef>

/// The loops that the codes of fields come from; as core/base/kernels.h.
namespace lpf::kernels {

/// Systems of equations that are solved side by side, so that none waits for its own divisions.
inline constexpr std::size_t kSystems = 8;

/// Where row i of each of them begins, when it is counted from column 0: rows are kept from the
/// diagonal on, with the right-hand side behind them, one after the other.
[[nodiscard]] constexpr std::size_t row_of_system(std::size_t i, std::size_t n) {
    return i * n - i * (i - 1) / 2;
}
[[nodiscard]] constexpr std::size_t size_of_system(std::size_t n) { return n * (n + 3) / 2; }

/// Solves A x = b for kSystems symmetric positive definite A of n rows: values of all systems lie
/// side by side. Unknowns that depend linearly on those before them become 0, and so do those whose
/// rows and columns are 0; the digits of a system depend neither on these nor on the others.
/// @param a value (i, j) of system s at (row_of_system(i, n) + j) kSystems + s, j >= i; b is column
/// n. Destroyed  @param x value i of system s at i kSystems + s
void solve_definite(double* a, std::size_t n, double* x);

/// Finds the atoms whose coefficients coordinate descent would move by more than the tolerance,
/// each from the code as it is.
/// @param diagonal of the Gram matrix  @param inverse_diagonal as for descent_sweep
/// @param atoms out, ascending; has room for d + 1  @returns how many
std::size_t find_moves(const float* diagonal, const float* inverse_diagonal, float threshold,
                       float tolerance, const float* code, const float* residual, std::size_t d,
                       unsigned* atoms);

/// One sweep of coordinate descent on |V - D a|^2 + 2 threshold |a|_1 over the atoms listed.
/// @param gram of D, d x d  @param inverse_diagonal of gram, 0 for an atom of norm 0
/// @param code, residual d coefficients a and d correlations D'(V - D a), in and out
void descent_sweep(const float* gram, std::size_t d, float threshold, const float* inverse_diagonal,
                   const unsigned* atoms, std::size_t count, float* code, float* residual);

}  // namespace lpf::kernels

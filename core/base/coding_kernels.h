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

/// Writes the systems that minimise the energy of several codes over their atoms in use: entry
/// (i, j) is that of the Gram matrix for atoms i and j of the system.
/// @param gram of D, d x d  @param n atoms of a system, at most
/// @param atoms number i of system s at i kSystems + s; any where it is not used
/// @param used alike: 1, or 0 where the system has fewer atoms  @param right the right-hand sides
void write_systems(const float* gram, std::size_t d, std::size_t n, const unsigned* atoms,
                   const double* used, const double* right, double* systems);

/// Solves A x = b for kSystems symmetric positive definite A of n rows: values of all systems lie
/// side by side. Unknowns that depend linearly on those before them become 0, and so do those whose
/// rows and columns are 0; the digits of a system depend neither on these nor on the others.
/// @param a value (i, j) of system s at (row_of_system(i, n) + j) kSystems + s, j >= i; b is column
/// n. Destroyed  @param x value i of system s at i kSystems + s
void solve_definite(double* a, std::size_t n, double* x);

/// Finds the atoms whose coefficients coordinate descent would move by more than the tolerance,
/// each from the code as it is.
/// @param diagonal of the Gram matrix  @param inverse_diagonal as for descent_sweeps
/// @param atoms out, ascending; has room for d + 1  @returns how many
std::size_t find_moves(const float* diagonal, const float* inverse_diagonal, float threshold,
                       float tolerance, const float* code, const float* residual, std::size_t d,
                       unsigned* atoms);

/// A code in coordinate descent on |V - D a|^2 + 2 threshold |a|_1.
struct Sweep {
    float threshold;
    const unsigned* atoms;  ///< that are visited
    std::size_t count;      ///< of these
    float* code;            ///< a: d coefficients, in and out
    float* residual;        ///< D'(V - D a): d correlations, in and out
};

/// One sweep of each of several codes, side by side: none waits for its own last step.
/// @param gram of D, d x d  @param inverse_diagonal of gram, 0 for an atom of norm 0
void descent_sweeps(const float* gram, std::size_t d, const float* inverse_diagonal,
                    const Sweep* sweeps, std::size_t n);

}  // namespace lpf::kernels

#pragma once

#include "api/codec/document.h"
#include "core/analysis.h"

namespace lpf {

/// The LPFs as a PLY document, one vertex each: seed (x y z, double), frame (t1x t1y t1z t2x t2y
/// t2z nx ny nz), radius, residual, dimension, and the sparse code as two lists, atom_indices and
/// coefficients, of the atoms that are used.
[[nodiscard]] Document fields_document(const AnalysisResult& analysis);

}  // namespace lpf

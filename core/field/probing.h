#pragma once

#include <memory>
#include <vector>

#include "core/field/frame.h"
#include "core/field/local_probing_field.h"
#include "core/field/pattern.h"
#include "core/field/target_area.h"
#include "core/shape/shape.h"

namespace lpf {

/// How a pattern point finds its point of the shape (paper Sec. 2.1 and 2.2).
enum class ProbingKind {
    AsOrthogonalAsPossible,  ///< the target point nearest in the pattern plane (the paper's)
    NoiseAware,              ///< local mean height over the plane; for noisy points
    NearestPoint,            ///< the nearest target point in space
    NearestTriangle          ///< projection on the nearest triangle; needs a mesh
};

/// What a probe works on and in; one for each thread, reused from LPF to LPF.
struct ProbeScratch {
    TargetArea target;          ///< in frame coordinates when probing
    std::vector<float> raster;  ///< cells of the operator's own
    std::vector<float> raster2;
    std::vector<int> cells;
    std::vector<int> cells2;
    std::vector<std::uint32_t> triangles;
};

/// Assigns to each pattern point u_i a point of the target area; writes the displacements v_i.
class ProbingOperator {
public:
    virtual ~ProbingOperator() = default;

    /// @param frame   the pose of the LPF
    /// @param curve   whether the target area is one-dimensional
    /// @param scratch scratch.target: the target area in frame coordinates
    /// @param v       out: x, y, z channels of pattern.padded_size() floats, padding zero. An empty
    ///                target area gives the zero field. Always finite.
    virtual void probe(const Frame& frame, bool curve, ProbeScratch& scratch, float* v) const = 0;
};

/// The paper's operator: nearest in the pattern plane, so that v_i is as orthogonal as possible.
std::unique_ptr<ProbingOperator> make_orthogonal_probing(const Pattern& pattern);

/// Nearest point in space: iterative closest points (Sec. 2.2). For comparison.
std::unique_ptr<ProbingOperator> make_nearest_point_probing(const Pattern& pattern);

/// Mean height of the target around each node under a Gaussian kernel; nodes keep their place in
/// the plane. A node without support is pulled to the mean of the nearest node that has it. On
/// curves, the mean cross-section along t1.
/// @param width of the kernel, its standard deviation [radius]
std::unique_ptr<ProbingOperator> make_noise_aware_probing(const Pattern& pattern, double width);

/// Points on the triangles of a mesh, so that a mesh has target areas like a cloud: the centroids
/// of a regular subdivision finer than `spacing`, and the triangle of each.
struct MeshSamples {
    Points points;                        ///< 3 x K
    std::vector<std::uint32_t> triangle;  ///< K
};
[[nodiscard]] MeshSamples sample_mesh(const Shape& mesh, double spacing);

/// The point where the pattern's normal through u_i meets the mesh, nearest to the plane; where it
/// meets nothing, the nearest point of the target's triangles in the plane's sense (Sec. 2.2).
/// @param grid over samples.points; all three must outlive the operator
std::unique_ptr<ProbingOperator> make_nearest_triangle_probing(const Pattern& pattern,
                                                               const Shape& mesh,
                                                               const MeshSamples& samples,
                                                               const PointGrid& grid);

}  // namespace lpf

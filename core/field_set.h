#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/analysis.h"
#include "core/base/aligned_floats.h"
#include "core/field/piece.h"
#include "core/field/probing.h"
#include "core/field/target_area.h"
#include "core/learn/dictionary_learning.h"
#include "core/shape/box.h"

namespace lpf {

/// The LPFs of a shape while they are worked on: poses over one pattern, and the shape prepared for
/// probing. The fields themselves (V, 3M x N) are never stored; each pass probes them anew.
class FieldSet {
public:
    /// Places LPFs all over the shape (paper Sec. 3.1): seeds, target areas, first poses.
    /// @param shape must outlive the set
    /// @param region where the LPFs are wanted: all that reach into it, no others
    FieldSet(const Shape& shape, const AnalysisParams& params, const Execution& execution,
             const Region& region = {});

    /// What a thread needs to work on one LPF after the other.
    struct Worker {
        ProbeScratch probe;
        AlignedFloats field;    ///< V_j, three channels of pattern.padded_size()
        AlignedFloats decoded;  ///< D alpha_j
    };

    /// Runs body(j, worker, chunk) for every LPF with a usable target area, `worker.field` freshly
    /// probed and `worker.probe.target` in frame coordinates. `chunk` numbers the fixed chunks of
    /// LPFs.
    using Body = std::function<void(std::size_t j, Worker& worker, std::size_t chunk)>;
    void for_each_probed(std::string_view phase, const Execution& execution,
                         const Body& body) const;

    /// For callers that choose the LPFs themselves: what a thread needs, the target area of one,
    /// the field of one.
    [[nodiscard]] Worker make_worker() const;
    void gather(std::size_t j, TargetArea& target) const;
    void probe(std::size_t j, ProbeScratch& scratch, float* field) const;

    /// The two steps of a probe, where an LPF is probed again and again.
    /// @param scratch scratch.target: what gather_around found
    void gather_around(std::size_t j, TargetArea& target) const;
    void probe_gathered(std::size_t j, ProbeScratch& scratch, float* field) const;

    /// All points of the shape in the target area of one, flattened; and those of another cloud.
    void gather_ball(std::size_t j, TargetArea& target) const { gather_ball(j, grid_, target); }
    void gather_ball(std::size_t j, const PointGrid& grid, TargetArea& target) const;

    /// The same for all LPFs and without probing: only the target area is gathered.
    void for_each_target(std::string_view phase, const Execution& execution,
                         const Body& body) const;

    /// The same with all points of the target area, flattened, also those that are not of the LPF's
    /// piece.
    void for_each_ball(std::string_view phase, const Execution& execution, const Body& body) const;

    /// The LPFs with a usable target area, ascending.
    [[nodiscard]] std::vector<std::size_t> usable() const;

    /// At most `count` of these, drawn at random, ascending; all of them if there are no more.
    [[nodiscard]] std::vector<std::size_t> draw_sample(int count, std::uint64_t random_seed) const;

    /// The fields of some LPFs as they are now, side by side.
    [[nodiscard]] AlignedFloats probe_sample(const std::vector<std::size_t>& sample,
                                             const Execution& execution) const;

    /// As-orthogonal-as-possible poses (Sec. 2.2): alternates probing with the rigid motion that
    /// minimises the norms of all v_i.
    void optimise_poses(int passes, const Execution& execution);

    /// Factor on lambda for LPF j: a smaller LPF has fewer points, and more noise in its units.
    [[nodiscard]] float lambda_share(std::size_t j) const {
        const double ratio = radius_ / frames[j].radius;
        return static_cast<float>(ratio * ratio) * noise_factors[j];
    }

    /// LPFs lie on the piece that they are about: their pose is that of the piece.
    [[nodiscard]] bool pose_is_fixed(std::size_t j) const { return pieces[j].exists(); }
    /// Whether that holds for all that have points enough for a pose.
    [[nodiscard]] bool poses_are_fixed() const;

    [[nodiscard]] std::size_t size() const { return frames.size(); }
    [[nodiscard]] std::size_t chunks() const;
    [[nodiscard]] const Pattern& pattern() const { return pattern_; }
    [[nodiscard]] const PointGrid& grid() const { return grid_; }

    std::vector<Frame> frames;
    std::vector<std::uint8_t> dimensions;  ///< Dimension of each
    std::vector<Piece> pieces;             ///< what each is about; the fields start from it
    std::vector<float> noise_factors;      ///< by which there is more noise there than usual

private:
    void place(const Points& targets, const AnalysisParams& params, const Region& region,
               const Execution& execution);
    void to_flat(std::size_t j, TargetArea& target) const;
    void to_members(std::size_t j, TargetArea& target) const;
    using Gather = void (FieldSet::*)(std::size_t j, TargetArea& target) const;
    void for_each_gathered(std::string_view phase, const Execution& execution, const Body& body,
                           Gather gather_points) const;

    Pattern pattern_;
    MeshSamples samples_;  // of a mesh that is probed as one
    PointGrid grid_;
    std::unique_ptr<ProbingOperator> operator_;
    double radius_;
    float target_radius_;
};

/// How far from a place points matter to the LPFs that move it [input length].
[[nodiscard]] double reach_of_fields(const AnalysisParams& params);

/// The pattern that the parameters ask for. @throws Error{InvalidParameter}
[[nodiscard]] Pattern make_pattern(const AnalysisParams& params);

/// The joint loop over LPFs that are in place (Sec. 3.2); `analyze` without the placing.
[[nodiscard]] AnalysisResult analyze(FieldSet& fields, const AnalysisParams& params,
                                     const Execution& execution);

}  // namespace lpf

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/field_set.h"
#include "core/resample.h"
#include "core/resampling/consensus.h"

namespace lpf {

/// The points that LPFs propose (paper Eq. 7): the places of their patterns, moved by their
/// reconstructed fields, where the shape has points to support them.
class Proposer {
public:
    /// @param fields, analysis, params must outlive the proposer
    /// @param spacing tau_p that the consensus will have [input length], > 0
    Proposer(const FieldSet& fields, const AnalysisResult& analysis, const ResampleParams& params,
             double spacing);

    /// The candidates of some LPFs that lie in a box [input length]: LPF by LPF, each from its
    /// centre outwards.
    [[nodiscard]] Candidates propose(std::span<const std::uint32_t> numbers,
                                     const Eigen::AlignedBox3d& box,
                                     const Execution& execution) const;

    /// Places of an LPF, on average.
    [[nodiscard]] double mean_places() const;

private:
    struct Place {
        Eigen::Vector2f at;        ///< in the disk [radius]
        Pattern::Stencil stencil;  ///< how the field is read there
    };
    struct Proposals {
        std::vector<Eigen::Vector3d> points;
        std::vector<std::uint32_t> field;
    };

    void propose(std::uint32_t j, const Eigen::AlignedBox3d& box, FieldSet::Worker& worker,
                 Proposals& proposals) const;
    void move_places(std::uint32_t j, const Eigen::AlignedBox3d& box, FieldSet::Worker& worker,
                     Proposals& proposals) const;
    [[nodiscard]] bool knows_field(std::uint32_t j, const TargetArea& target) const;
    void reconstruct(std::uint32_t j, FieldSet::Worker& worker) const;
    [[nodiscard]] float support_distance(const TargetArea& target, double radius) const;

    const FieldSet& fields_;
    const AnalysisResult& analysis_;
    const ResampleParams& params_;
    double spacing_;
    std::map<double, std::vector<Place>> places_;  // by the radius of the LPF
};

}  // namespace lpf

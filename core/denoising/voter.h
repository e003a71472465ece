#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/analysis.h"
#include "core/denoising/ballot.h"
#include "core/field/density_map.h"
#include "core/field/field_image.h"
#include "core/field/misfit_map.h"
#include "core/field/target_area.h"
#include "core/field_set.h"

namespace lpf {

/// A vector for each point of a target area: structure of arrays, not zeroed first.
struct Arrows {
    Eigen::ArrayXf x, y, z;

    explicit Arrows(std::size_t n) {
        for (auto* values : {&x, &y, &z}) values->resize(static_cast<Eigen::Index>(n));
    }
    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(x.size()); }

    /// @param by a rotation, perhaps with a factor
    void rotate(const Eigen::Matrix3f& by);
};

/// How an LPF suits its own points.
struct Fit {
    MisfitMap misfit;
    bool is_plain = false;  ///< its piece alone suits them no worse than its field does
};

/// What an LPF's own points say about how far it is to be believed, place by place.
struct Trust {
    const MisfitMap& misfit;    ///< measured where they lay at first
    const DensityMap& density;  ///< counted where they lie now
};

/// How LPFs vote on the points near them: to move from where they are to their fields (paper
/// Sec. 4.2).
class Voter {
public:
    /// @param sharp  votes count by the cube of the representation error alone
    /// @param width  of the likely moves [input length]; 0 = any move is likely
    Voter(const FieldSet& fields, const AnalysisResult& analysis, bool sharp, double width);

    /// The radius of LPF j [radius of the analysis].
    [[nodiscard]] float size_of(std::size_t j) const;

    /// The consolidated field of LPF j. @param worker room to decode it in
    [[nodiscard]] FieldImage image(std::size_t j, FieldSet::Worker& worker) const;

    /// A field at the points of a flattened target area: T(x, y) between the nodes, too, so that
    /// nothing snaps to them.
    [[nodiscard]] static Arrows field_at(const TargetArea& target, const FieldImage& image);

    /// Leaves of a field what leads to the piece: across a curve, off a surface.
    static void stop_sliding(const Piece& piece, Arrows& field);

    /// Leaves of a field what does not: sliding along the piece.
    static void leave_only_sliding(const Piece& piece, Arrows& field);

    /// How LPF j suits its own points. A code that has much else to say, as at the end of a curve,
    /// may say wrong things about them. @param field at each of them
    [[nodiscard]] Fit fit(std::size_t j, const TargetArea& target, const Arrows& field) const;

    /// Where the members of the piece of LPF j lie.
    [[nodiscard]] DensityMap density(std::size_t j, const TargetArea& target) const;

    /// Casts the votes of LPF j for the points of a flattened target area.
    void cast(std::size_t j, const TargetArea& target, const Arrows& field, const Trust& trust,
              Ballot& ballot) const;

private:
    [[nodiscard]] Arrows wanted_moves(const Piece& piece, const TargetArea& target,
                                      const Arrows& field) const;
    [[nodiscard]] Eigen::ArrayXf weights_by_place(std::size_t j, const TargetArea& target,
                                                  const Trust& trust) const;
    void cast_moves(std::size_t j, const TargetArea& target, Eigen::ArrayXf weights, Arrows& moves,
                    Ballot& ballot) const;

    const FieldSet& fields_;
    const AnalysisResult& analysis_;
    bool sharp_;
    float width_;  // [radius of the analysis]
    std::vector<float> reliability_;
};

}  // namespace lpf

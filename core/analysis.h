#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/parallel.h"
#include "core/field/frame.h"
#include "core/field/pattern.h"
#include "core/field/probing.h"
#include "core/learn/dictionary.h"
#include "core/learn/lasso.h"
#include "core/learn/sparse_code.h"
#include "core/shape/noise_map.h"
#include "core/shape/shape.h"

namespace lpf {

enum class PatternKind { Grid, RandomDisk, Custom };

struct PatternParams {
    PatternKind kind = PatternKind::Grid;
    int points = 193;               ///< M, 5 to 12849; a grid takes the nearest possible number
    Eigen::Matrix3Xf offsets = {};  ///< for PatternKind::Custom: 3 x M [radius]
};

/// Parameters of the joint analysis (paper Sec. 3).
struct AnalysisParams {
    double radius = 0.0;  ///< r [input length], > 0. No universal default (Sec. 3.6)
    PatternParams pattern = {};
    ProbingKind probing = ProbingKind::AsOrthogonalAsPossible;
    double target_radius = 1.1;  ///< of the target area [radius], 1 to 2 (Sec. 3.1)
    double seed_spacing = 0.5;   ///< least distance of seeds [radius]; 0 = one seed per point
    /// Standard deviation of the points off the shape [input length]. LPFs keep to one sheet or
    /// curve then; 0 = unknown: an LPF is about all that its target area holds.
    double noise = 0.0;
    NoiseMap noise_map = {};       ///< where there is more of it, and less
    bool adapt_radius = false;     ///< LPFs as large as the shape around them allows
    double least_radius = 0.0;     ///< of those that adapt [input length]
    bool principal_frames = true;  ///< start from principal directions; false = random (Sec. 3.1)
    int pose_iterations = 2;       ///< as-orthogonal-as-possible passes (Sec. 2.2), 0 to 50
    int atoms = 16;                ///< d, 1 to 256 (Sec. 3.6)
    double lambda = 0.2;           ///< of Eq. 2, for fields in units of the radius, >= 0
    LassoMethod lasso = LassoMethod::CoordinateDescent;
    bool debias = false;         ///< least squares on the support after coding (sharp shapes)
    int iterations = 10;         ///< of the joint loop, 1 to 1000
    int learning_sample = 8192;  ///< LPFs that the dictionary is learned on, at most
    int learning_rounds = 5;     ///< rounds of coding and dictionary update in an iteration
    double smoothing = 0.125;    ///< kernel width of NoiseAware probing [radius], .05 to .5
    std::uint64_t random_seed = 1;

    /// Start from this dictionary instead of random LPFs; its pattern replaces `pattern`.
    std::optional<Dictionary> initial_dictionary = {};
    bool keep_dictionary = false;  ///< code against it, never change it
};

/// Energy of Eq. 2 per LPF, after each step of one iteration (Sec. 3.2). The first two never rise
/// when every LPF is learned on; the third may (Sec. 3.6).
struct IterationEnergy {
    double learning = 0.0;  ///< after step 1, dictionary learning
    double pose = 0.0;      ///< after step 2, pose optimisation
    double probing = 0.0;   ///< after step 3, the LPFs probed anew
};

/// Everything downstream needs. N LPFs; `frames`, `codes`, `residuals`, `dimensions` run along.
struct AnalysisResult {
    Dictionary dictionary;
    std::vector<Frame> frames;
    SparseCodes codes;                     ///< N x d
    std::vector<float> residuals;          ///< RMS of |v_i - (D alpha)_i| [radius]
    std::vector<std::uint8_t> dimensions;  ///< 0 too few points, 1 curve, 2 surface
    std::vector<float> usage;              ///< d: share of LPFs that use the atom, 0 to 1
    std::vector<IterationEnergy> energy;   ///< one per iteration
    double radius = 0.0;                   ///< as in the parameters [input length]
    double lambda = 0.0;
};

/// @throws Error{InvalidParameter} naming the field that is out of range
void validate(const AnalysisParams& params);

/// @throws Error{TooFewPoints} below 3 points, Error{InvalidParameter} for a coordinate that is not
/// finite, Error{DegenerateShape} if all points coincide
void check_points(const Points& points, const Execution& execution);

/// The joint analysis of a shape (paper Sec. 3.2): poses, dictionary and sparse codes.
/// @param shape finite points, at least 3, not all the same
/// @throws Error{InvalidParameter, TooFewPoints, DegenerateShape, IncompatibleDictionary,
/// Cancelled}
[[nodiscard]] AnalysisResult analyze(const Shape& shape, const AnalysisParams& params,
                                     const Execution& execution);

}  // namespace lpf

#include "core/analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/kernels.h"
#include "core/field_set.h"
#include "core/learn/dictionary_learning.h"
#include "core/learn/pose.h"
#include "core/shape/extent.h"

namespace lpf {
namespace {

/// Eq. 2 of one LPF, less nothing: |V - D a|^2 + lambda |a|_1.
struct FieldEnergy {
    double before = 0.0;  // with the code and dictionary of the last iteration, probed anew
    double learning = 0.0;
    double pose = 0.0;
};

void require(bool right, const std::string& message, const std::string& field) {
    if (!right) throw Error(ErrorCode::InvalidParameter, message, field);
}

double l1_norm(std::span<const float> code) {
    double sum = 0.0;
    for (const float value : code) sum += std::abs(static_cast<double>(value));
    return sum;
}

/// The state of the joint loop; one method for each line of the paper's Sec. 3.2.
class JointLoop {
public:
    JointLoop(FieldSet& fields, const AnalysisParams& params)
        : fields_(fields),
          params_(params),
          coder_{static_cast<float>(params.lambda), params.lasso},
          dictionary_(params.initial_dictionary ? *params.initial_dictionary
                                                : Dictionary(fields.pattern(), params.atoms)),
          previous_(dictionary_),
          codes_(fields.size(), dictionary_.atoms()),
          sample_(fields.draw_sample(params.learning_sample, params.random_seed)) {}

    /// Step 1: learn the dictionary on a sample of the LPFs (Sec. 3.3).
    void learn(const Execution& execution) {
        previous_ = dictionary_;
        if (params_.keep_dictionary) return;
        FieldSample sample{
            fields_.probe_sample(sample_, part_of(execution, 0.0, 0.3)), dictionary_.stride(), {}};
        for (const std::size_t j : sample_) sample.lambda_share.push_back(fields_.lambda_share(j));
        if (energy_.empty() && !params_.initial_dictionary) {
            dictionary_ =
                draw_dictionary(fields_.pattern(), params_.atoms, sample, params_.random_seed);
        }
        SparseCodes codes(sample.count(), dictionary_.atoms());
        for (std::size_t i = 0; i < sample.count(); ++i) {
            std::ranges::copy(codes_[sample_[i]], codes[i].begin());
        }
        learn_dictionary(sample, coder_, params_.learning_rounds, params_.random_seed, dictionary_,
                         codes, part_of(execution, 0.3, 1.0));
    }

    /// Steps 1 to 3 for every LPF in one pass: probe it where it now is (closing the loop of the
    /// iteration before), code it, and move it to where it fits its code best.
    void code_and_pose(const Execution& execution) {
        pass("analyze", execution, {.opens = true, .closes = false});
    }

    /// Step 3 of the last iteration, and the codes that belong to the last poses.
    void close(const Execution& execution) {
        previous_ = dictionary_;
        pass("encode", execution, {.opens = false, .closes = true});
    }

    /// Both for LPFs that stay where they are: the last iteration in one pass.
    void code_and_close(const Execution& execution) {
        pass("analyze", execution, {.opens = true, .closes = true});
        energy_.back().probing = energy_.back().pose;
    }

    AnalysisResult result() && {
        AnalysisResult result{std::move(dictionary_), fields_.frames, std::move(codes_), {}, {}, {},
                              std::move(energy_),     params_.radius, params_.lambda};
        result.residuals = std::move(residuals_);
        result.dimensions = fields_.dimensions;
        result.usage = usage_of_atoms(result.codes);
        return result;
    }

private:
    struct Part {
        bool opens;   ///< an iteration
        bool closes;  ///< the loop: LPFs stay, and their codes are the last ones
    };

    void pass(std::string_view phase, const Execution& execution, Part part) {
        const CodingMatrices matrices(dictionary_);
        std::vector<FieldEnergy> chunk_energy(fields_.chunks());
        residuals_.assign(fields_.size(), 0.0F);
        fields_.for_each_block(
            phase, execution, dictionary_.atoms(), [&](FieldSet::Block& block, std::size_t chunk) {
                FieldEnergy& energy = chunk_energy[chunk];
                decode(previous_, block);
                for (std::size_t i = 0; i < block.count; ++i) {
                    energy.before += field_energy(block, i);
                }
                encode(matrices, block);
                decode(dictionary_, block);
                for (std::size_t i = 0; i < block.count; ++i) {
                    const double learned = field_energy(block, i);
                    energy.learning += learned;
                    const bool stays = part.closes || fields_.pose_is_fixed(block.number[i]);
                    if (!stays) pose(block, i);
                    energy.pose += stays ? learned : field_energy(block, i);
                }
                if (part.closes) finish(matrices, block);
            });
        record(chunk_energy, part.opens);
    }

    /// The codes as they are to be, and what they leave of the fields.
    void finish(const CodingMatrices& matrices, FieldSet::Block& block) {
        if (params_.debias) {
            for (std::size_t i = 0; i < block.count; ++i) {
                debias({matrices.gram, correlations(block, i), 0.0F}, codes_[block.number[i]]);
            }
            decode(dictionary_, block);
        }
        for (std::size_t i = 0; i < block.count; ++i) {
            residuals_[block.number[i]] = residual(block, i);
        }
    }

    /// D alpha of each.
    void decode(const Dictionary& dictionary, FieldSet::Block& block) {
        const std::size_t d = codes_atoms();
        for (std::size_t i = 0; i < block.count; ++i) {
            std::ranges::copy(codes_[block.number[i]],
                              block.codes.begin() + static_cast<std::ptrdiff_t>(i * d));
        }
        dictionary.decode_all(std::span(block.codes).first(block.count * d), block.decoded);
    }

    void encode(const CodingMatrices& matrices, FieldSet::Block& block) {
        Coder::correlate(matrices, std::span(block.fields).first(block.count * matrices.stride),
                         block.correlations);
        std::array<LassoTask, kFieldsOfBlock> tasks;
        for (std::size_t i = 0; i < block.count; ++i) {
            const std::size_t j = block.number[i];
            tasks[i] = {correlations(block, i), coder_.lambda * fields_.lambda_share(j), codes_[j]};
        }
        coder_.solve(matrices.gram, std::span(tasks).first(block.count));
    }

    [[nodiscard]] std::span<const float> correlations(const FieldSet::Block& block,
                                                      std::size_t i) const {
        const std::size_t width = whole_lines(codes_atoms());
        return std::span(block.correlations).subspan(i * width, codes_atoms());
    }

    /// Moves LPF and field to where they fit the code best.
    void pose(FieldSet::Block& block, std::size_t i) {
        float* field = block.field(i).data();
        const RigidFit fit = fit_pose(dictionary_.pattern(), field, block.decoded_field(i).data());
        apply_pose(fit, fields_.frames[block.number[i]]);
        move_field(dictionary_.pattern(), fit, field);
    }

    [[nodiscard]] std::size_t codes_atoms() const {
        return static_cast<std::size_t>(codes_.atoms());
    }

    [[nodiscard]] static float squared_distance(FieldSet::Block& block, std::size_t i) {
        return kernels::squared_distance(block.field(i).data(), block.decoded_field(i).data(),
                                         block.field(i).size());
    }

    [[nodiscard]] double field_energy(FieldSet::Block& block, std::size_t i) const {
        const std::size_t j = block.number[i];
        return static_cast<double>(squared_distance(block, i)) +
               params_.lambda * static_cast<double>(fields_.lambda_share(j)) * l1_norm(codes_[j]);
    }

    [[nodiscard]] float residual(FieldSet::Block& block, std::size_t i) const {
        return std::sqrt(squared_distance(block, i) /
                         static_cast<float>(dictionary_.pattern().size()));
    }

    /// Sums in the order of the chunks, so that no digit depends on the threads.
    void record(const std::vector<FieldEnergy>& chunk_energy, bool opens_iteration) {
        FieldEnergy sum;
        for (const FieldEnergy& part : chunk_energy) {
            sum.before += part.before;
            sum.learning += part.learning;
            sum.pose += part.pose;
        }
        const auto n = static_cast<double>(std::max<std::size_t>(1, fields_.size()));
        if (!energy_.empty()) energy_.back().probing = sum.before / n;
        if (opens_iteration) energy_.push_back({sum.learning / n, sum.pose / n, 0.0});
    }

    FieldSet& fields_;
    const AnalysisParams& params_;
    Coder coder_;
    Dictionary dictionary_;
    Dictionary previous_;  // that the codes were made with, until they are made anew
    SparseCodes codes_;
    std::vector<std::size_t> sample_;  // the LPFs that the dictionary is learned on
    std::vector<float> residuals_;
    std::vector<IterationEnergy> energy_;
};

}  // namespace

void check_points(const Points& points, const Execution& execution) {
    check_number_of_points(static_cast<std::size_t>(points.cols()));
    if (!all_finite(points, execution)) {
        throw Error(ErrorCode::InvalidParameter, "The shape has coordinates that are not finite.");
    }
    check_extent(bounding_box(points, execution).sizes().maxCoeff());
}

void validate(const AnalysisParams& p) {
    require(std::isfinite(p.radius) && p.radius > 0, "The radius must be positive.", "radius");
    require(p.target_radius >= 1 && p.target_radius <= 2,
            "The target radius must be 1 to 2 pattern radii.", "targetRadius");
    require(p.seed_spacing >= 0 && p.seed_spacing <= 1,
            "The spacing of the seeds must be 0 to 1 radius, so that the LPFs cover the shape.",
            "seedSpacing");
    require(std::isfinite(p.noise) && p.noise >= 0, "The noise must be 0 or more.", "noise");
    require(p.pose_iterations >= 0 && p.pose_iterations <= 50,
            "The pose iterations must be 0 to 50.", "poseIterations");
    require(p.atoms >= 1 && p.atoms <= 256, "The dictionary takes 1 to 256 atoms.", "atoms");
    require(std::isfinite(p.lambda) && p.lambda >= 0, "Lambda must be 0 or more.", "lambda");
    require(p.iterations >= 1 && p.iterations <= 1000, "The iterations must be 1 to 1000.",
            "analysisIterations");
    require(p.learning_sample >= 1, "The learning sample needs at least one LPF.",
            "learningSample");
    require(p.learning_rounds >= 1 && p.learning_rounds <= 100,
            "The rounds of learning must be 1 to 100.", "learningRounds");
    require(p.smoothing >= 0.05 && p.smoothing <= 0.5, "The smoothing must be .05 to .5 radius.",
            "smoothing");
    if (!p.initial_dictionary) return;
    if (p.initial_dictionary->atoms() != p.atoms) {
        throw Error(ErrorCode::IncompatibleDictionary,
                    "The dictionary has " + std::to_string(p.initial_dictionary->atoms()) +
                        " atoms, but " + std::to_string(p.atoms) + " are asked for.",
                    "atoms");
    }
}

AnalysisResult analyze(FieldSet& fields, const AnalysisParams& params, const Execution& execution) {
    JointLoop loop(fields, params);
    const double passes = params.iterations + 1;
    const bool stay = fields.poses_are_fixed();
    for (int i = 0; i < params.iterations; ++i) {
        loop.learn(part_of(execution, i / passes, (i + 0.3) / passes));
        const bool last = i + 1 == params.iterations;
        if (last && stay) {
            loop.code_and_close(part_of(execution, (i + 0.3) / passes, 1.0));
            return std::move(loop).result();
        }
        loop.code_and_pose(part_of(execution, (i + 0.3) / passes, (i + 1) / passes));
    }
    loop.close(part_of(execution, params.iterations / passes, 1.0));
    return std::move(loop).result();
}

AnalysisResult analyze(const Shape& shape, const AnalysisParams& params,
                       const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points, execution);
    FieldSet fields(shape, params, part_of(execution, 0.0, 0.05));
    fields.optimise_poses(params.pose_iterations, part_of(execution, 0.05, 0.2));
    return analyze(fields, params, part_of(execution, 0.2, 1.0));
}

}  // namespace lpf

#include "core/analysis.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/field_set.h"
#include "core/gathered_fields.h"
#include "core/joint_steps.h"
#include "core/learn/dictionary_learning.h"
#include "core/shape/extent.h"

namespace lpf {
namespace {

void require(bool right, const std::string& message, const std::string& field) {
    if (!right) throw Error(ErrorCode::InvalidParameter, message, field);
}

/// Bytes of dictionaries that are at hand together, and iterations: each has energies of its own.
constexpr std::size_t kPathBytes = 2U << 20U;
constexpr std::size_t kMostTogether = 32;

/// So many LPFs go through these together: each dictionary is fetched once for all of them.
constexpr std::size_t kFieldsAlongPath = 128;

/// LPFs whose fields are at hand need no company.
constexpr std::size_t kFieldsPerChunk = 32;

/// Runs body(i, n numbers from the i-th on) for as many as make a block.
template <class Body>
void for_each_block(std::span<const std::size_t> numbers, const Body& body) {
    for (std::size_t i = 0; i < numbers.size(); i += kFieldsOfBlock) {
        body(i, numbers.subspan(i, std::min(kFieldsOfBlock, numbers.size() - i)));
    }
}

/// The joint loop; one method for each line of the paper's Sec. 3.2. The dictionary depends on
/// nothing but the LPFs that it is learned on. These lead, some iterations at a time, and the
/// others follow: each goes through all of these iterations while its points are at hand.
class JointLoop {
public:
    JointLoop(FieldSet& fields, const AnalysisParams& params)
        : fields_(fields),
          params_(params),
          stays_(fields.poses_are_fixed()),
          dictionary_(params.initial_dictionary ? *params.initial_dictionary
                                                : Dictionary(fields.pattern(), params.atoms)),
          steps_(fields, params, dictionary_.atoms()),
          energy_(static_cast<std::size_t>(params.iterations) + 1),
          leaders_(fields.draw_sample(params.learning_sample, params.random_seed)),
          sample_{{}, dictionary_.stride(), {}} {
        std::ranges::set_difference(fields.usable(), leaders_, std::back_inserter(followers_));
        for (const std::size_t j : leaders_) sample_.lambda_share.push_back(fields.lambda_share(j));
        if (params.keep_dictionary) matrices_ = std::make_shared<CodingMatrices>(dictionary_);
    }

    void run(const Execution& execution) {
        const int together = iterations_together();
        for (int first = 0; first < params_.iterations; first += together) {
            const int end = std::min(first + together, params_.iterations);
            const double all = params_.iterations;
            const Execution part = part_of(execution, first / all, end / all);
            lead(first, end, part_of(part, 0.0, share_of_leaders()));
            follow(part_of(part, share_of_leaders(), 1.0));
            path_.erase(path_.begin(), path_.end() - 1);
        }
    }

    AnalysisResult result() && {
        AnalysisResult result{std::move(dictionary_),  fields_.frames,
                              std::move(steps_.codes), std::move(steps_.residuals),
                              fields_.dimensions,      {},
                              mean_energies(),         params_.radius,
                              params_.lambda};
        result.usage = usage_of_atoms(result.codes);
        return result;
    }

private:
    [[nodiscard]] int iterations_together() const {
        const std::size_t atoms = steps_.codes.atoms();
        const std::size_t bytes = 2 * sizeof(float) * dictionary_.stride() * atoms;
        return static_cast<int>(std::clamp<std::size_t>(kPathBytes / bytes, 1, kMostTogether));
    }

    /// Of the work: learning takes about as long again.
    [[nodiscard]] double share_of_leaders() const {
        const double leaders = 2 * static_cast<double>(leaders_.size());
        return leaders / std::max(1.0, leaders + static_cast<double>(followers_.size()));
    }

    /// Takes the leaders through some iterations, and leaves the path that they went.
    void lead(int first, int end, const Execution& execution) {
        const bool is_last = end == params_.iterations;
        const int steps = end - first + static_cast<int>(is_last && !stays_);
        for (int i = 0; i < steps; ++i) {
            const Execution part =
                step_of(execution, static_cast<std::size_t>(i), static_cast<std::size_t>(steps));
            sample_.fields = AlignedFloats();  // before its like takes as much
            sample_.fields = fields_.probe_sample(leaders_, part_of(part, 0.0, 0.3));
            // After all iterations come the codes that belong to the last poses.
            if (first + i < params_.iterations) learn(first + i, part_of(part, 0.3, 0.9));
            step_on(first + i, is_last && i + 1 == steps, part_of(part, 0.9, 1.0));
        }
        sample_.fields = AlignedFloats();  // its memory is for others now
    }

    /// Step 1: learn the dictionary on the leaders (Sec. 3.3).
    void learn(int iteration, const Execution& execution) {
        if (params_.keep_dictionary) return;
        if (iteration == 0 && !params_.initial_dictionary) {
            dictionary_ =
                draw_dictionary(fields_.pattern(), params_.atoms, sample_, params_.random_seed);
        }
        SparseCodes codes(leaders_.size(), dictionary_.atoms());
        for (std::size_t i = 0; i < leaders_.size(); ++i) {
            std::ranges::copy(steps_.codes[leaders_[i]], codes[i].begin());
        }
        learn_dictionary(sample_, steps_.coder(), params_.learning_rounds, params_.random_seed,
                         dictionary_, codes, execution);
        matrices_ = std::make_shared<CodingMatrices>(dictionary_);
    }

    /// Takes the leaders, as they were probed to learn from, one iteration on.
    void step_on(int number, bool closes, const Execution& execution) {
        path_.push_back({matrices_, number, closes});
        const std::size_t stride = sample_.stride;
        Sums sums(chunk_count(leaders_.size(), kFieldsPerChunk) * 2);
        parallel_for(
            execution, "analyze", "fields", leaders_.size(), kFieldsPerChunk,
            [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                BlockRoom room(stride, dictionary_.atoms());
                const auto numbers = std::span(leaders_).subspan(begin, end - begin);
                for_each_block(numbers, [&](std::size_t i, auto some) {
                    const auto fields = std::span(sample_.fields)
                                            .subspan((begin + i) * stride, some.size() * stride);
                    go_through(path_.size() - 1, room.block(some, fields), &sums[2 * chunk]);
                });
            });
        add_up(sums, path_.size() - 1);
    }

    /// Takes the followers through the whole path.
    void follow(const Execution& execution) {
        Sums sums(chunk_count(followers_.size(), kFieldsAlongPath) * path_.size());
        parallel_for(execution, "analyze", "fields", followers_.size(), kFieldsAlongPath,
                     [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                         BlockRoom room(sample_.stride, dictionary_.atoms());
                         AlignedFloats fields(kFieldsOfBlock * sample_.stride);
                         const auto numbers = std::span(followers_).subspan(begin, end - begin);
                         GatheredFields gathered(fields_, numbers);
                         for (std::size_t step = 1; step < path_.size(); ++step) {
                             for_each_block(numbers, [&](std::size_t i, auto some) {
                                 const FieldBlock block = room.block(
                                     some, std::span(fields).first(some.size() * sample_.stride));
                                 for (std::size_t k = 0; k < some.size(); ++k) {
                                     gathered.probe(i + k, block.field(k).data());
                                 }
                                 go_through(step, block, &sums[chunk * path_.size() + step - 1]);
                             });
                         }
                     });
        add_up(sums, 1);
    }

    /// One iteration of the path. @param sums of the iteration before, and of this one
    void go_through(std::size_t step, const FieldBlock& block, IterationEnergy* sums) {
        steps_.close(path_[step - 1], block, sums[0]);
        steps_.iterate(path_[step], block, sums[1]);
    }

    /// Energies of each chunk: of the iteration before a part of the path, and of its iterations.
    using Sums = std::vector<IterationEnergy>;

    /// Adds them up in the order of the chunks, so that no digit depends on the threads.
    /// @param step where the part begins; it goes to the end of the path
    void add_up(const Sums& sums, std::size_t step) {
        const int before = path_[step].number - 1;
        const std::size_t of_chunk = path_.size() - step + 1;
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const int number = before + static_cast<int>(k % of_chunk);
            if (number < 0) continue;
            IterationEnergy& sum = energy_[static_cast<std::size_t>(number)];
            sum.learning += sums[k].learning;
            sum.pose += sums[k].pose;
            sum.probing += sums[k].probing;
        }
    }

    [[nodiscard]] std::vector<IterationEnergy> mean_energies() const {
        const auto n = static_cast<double>(std::max<std::size_t>(1, fields_.size()));
        std::vector<IterationEnergy> means;
        for (int i = 0; i < params_.iterations; ++i) {
            const IterationEnergy& sum = energy_[static_cast<std::size_t>(i)];
            means.push_back({sum.learning / n, sum.pose / n, sum.probing / n});
        }
        if (stays_) means.back().probing = means.back().pose;
        return means;
    }

    FieldSet& fields_;
    const AnalysisParams& params_;
    bool stays_;  // where all LPFs do, the last iteration gives the last codes
    Dictionary dictionary_;
    std::shared_ptr<const CodingMatrices> matrices_;  // of the dictionary as it was last learned
    JointSteps steps_;
    Sums energy_;                         // of all LPFs; one more for the codes of the last poses
    std::vector<std::size_t> leaders_;    // the LPFs that the dictionary is learned on
    std::vector<std::size_t> followers_;  // all others
    FieldSample sample_;                  // the fields of the leaders
    std::vector<Iteration> path_ = std::vector<Iteration>(1);  // some, and the one before them
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
    loop.run(execution);
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

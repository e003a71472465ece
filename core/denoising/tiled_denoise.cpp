#include "core/denoising/tiled_denoise.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/joined_progress.h"
#include "core/denoising/deconvolution.h"
#include "core/denoising/outer_iteration.h"
#include "core/field_set.h"
#include "core/shape/extent.h"
#include "core/shape/outliers.h"
#include "core/shape/tiling.h"

namespace lpf {
namespace {

/// Leaves the LPFs whose seeds lie in the box.
void keep_own(const Box& box, AnalysisResult& part) {
    std::vector<float> codes;
    std::size_t kept = 0;
    for (std::size_t j = 0; j < part.frames.size(); ++j) {
        if (!box.holds(part.frames[j].centre)) continue;
        part.frames[kept] = part.frames[j];
        part.residuals[kept] = part.residuals[j];
        part.dimensions[kept] = part.dimensions[j];
        codes.insert(codes.end(), part.codes[j].begin(), part.codes[j].end());
        ++kept;
    }
    part.frames.resize(kept);
    part.residuals.resize(kept);
    part.dimensions.resize(kept);
    part.codes = SparseCodes(std::move(codes), part.codes.atoms());
}

using Parts = std::vector<std::optional<AnalysisResult>>;

/// Energies are those of LPFs on average: each part counts by how many it has.
std::vector<IterationEnergy> mean_energy(const Parts& parts) {
    double fields = 0;
    for (const auto& part : parts) fields += static_cast<double>(part->frames.size());
    std::vector<IterationEnergy> mean(parts.front()->energy.size());
    for (const auto& part : parts) {
        const double share = static_cast<double>(part->frames.size()) / std::max(1.0, fields);
        for (std::size_t i = 0; i < mean.size(); ++i) {
            mean[i].learning += share * part->energy[i].learning;
            mean[i].pose += share * part->energy[i].pose;
            mean[i].probing += share * part->energy[i].probing;
        }
    }
    return mean;
}

/// The LPFs of all tiles, one tile behind the other.
AnalysisResult join(Parts parts) {
    std::vector<IterationEnergy> energy = mean_energy(parts);
    AnalysisResult all = *std::move(parts.front());
    std::vector<float> codes = all.codes.values();
    const auto append = [](auto& to, const auto& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    for (std::size_t i = 1; i < parts.size(); ++i) {
        append(all.frames, parts[i]->frames);
        append(all.residuals, parts[i]->residuals);
        append(all.dimensions, parts[i]->dimensions);
        append(codes, parts[i]->codes.values());
        parts[i].reset();
    }
    all.codes = SparseCodes(std::move(codes), all.dictionary.atoms());
    all.usage = usage_of_atoms(all.codes);
    all.energy = std::move(energy);
    return all;
}

/// Of the points in the box; those on each other lie in the same tile.
std::size_t count_duplicates(const Points& points, const Box& box, const Execution& execution) {
    const auto flags = find_duplicates(points, {.threads = 1, .stop = execution.stop});
    std::size_t count = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        count += flags[i] && box.holds(points.col(static_cast<Eigen::Index>(i)));
    }
    return count;
}

/// A cloud that is denoised tile by tile; one method for each step.
class TiledDenoiser {
public:
    TiledDenoiser(const PointSource& source, const DenoiseParams& params,
                  const TilingParams& tiling, const Execution& execution)
        : source_(source),
          params_(params),
          sketch_(checked(make_sketch(source, execution))),
          partition_(sketch_, static_cast<double>(tiling.points)),
          tiles_(source, partition_,
                 std::max(reach_of_fields(params.analysis),
                          kReachOfDeconvolution * params.analysis.noise),
                 execution),
          excerpt_(make_excerpt(source,
                                Partition(sketch_, static_cast<double>(tiling.patch_points)),
                                tiling.patches, reach_of_fields(params.analysis), execution)),
          counts_duplicates_(tiling.count_duplicates) {}

    TiledDenoising run(const Execution& execution) {
        const double noise = params_.analysis.noise;
        std::vector<double> rms_moves;
        double bent = 0.0;
        for (std::size_t i = 0;; ++i) {
            const Execution part = part_of_iteration(execution, params_, i);
            const Execution moving = part_of(part, 0.0, kShareOfMoves);
            if (!params_.analysis.keep_dictionary) learn(part_of(moving, 0.0, kShareOfLearning));
            Parts parts(tiles_.size());
            rms_moves.push_back(move_all(parts, part_of(moving, kShareOfLearning, 1.0)));
            if (i == 0 && is_deconvolved(params_)) {
                bent = deconvolve_all(noise, part_of(part, kShareOfMoves, 1.0));
            }
            if (!goes_on(params_, rms_moves, bent)) {
                report_done(execution, "deconvolve", "tiles");
                return {std::move(moves_), std::move(rms_moves), join(std::move(parts)),
                        duplicates_};
            }
            prepare_next(*params_.analysis.initial_dictionary, params_);
        }
    }

private:
    static constexpr double kShareOfLearning = 0.05;

    struct Deconvolved {
        std::uint32_t index;   ///< of the point
        Eigen::Vector3f move;  ///< from where it was at first
    };

    static Sketch checked(Sketch sketch) {
        check_number_of_points(sketch.of);
        check_extent((sketch.high - sketch.low).maxCoeff());
        return sketch;
    }

    /// Some points where they were at first.
    [[nodiscard]] Points load(std::span<const std::uint32_t> indices) const {
        Points points;
        source_.read(indices, points);
        return points;
    }

    /// The same points where they are now.
    [[nodiscard]] Shape moved(Points points, std::span<const std::uint32_t> indices) const {
        for (std::size_t i = 0; i < indices.size() && !moves_.empty(); ++i) {
            points.col(static_cast<Eigen::Index>(i)) += moves_[indices[i]].cast<double>();
        }
        return {{std::move(points), {}}, {}};
    }

    /// The dictionary that all tiles share.
    void learn(const Execution& execution) {
        const Shape part = moved(load(excerpt_.points), excerpt_.points);
        FieldSet fields(part, params_.analysis, part_of(execution, 0.0, 0.3), excerpt_.boxes);
        fields.optimise_poses(params_.analysis.pose_iterations, part_of(execution, 0.3, 0.5));
        params_.analysis.initial_dictionary =
            analyze(fields, params_.analysis, part_of(execution, 0.5, 1.0)).dictionary;
    }

    /// Moves all points by one outer iteration. @param parts out, the LPFs of each tile
    /// @returns the RMS of the moves
    double move_all(Parts& parts, const Execution& execution) {
        // Tiles see where the points around them were before.
        std::vector<Eigen::Vector3f> moves = moves_;
        moves.resize(source_.size(), Eigen::Vector3f::Zero());
        std::vector<double> squares(tiles_.size(), 0.0);
        for_each_tile("denoise", execution, [&](std::size_t tile, const Execution& alone) {
            parts[tile] = move_tile(tile, moves, squares[tile], alone);
        });
        moves_ = std::move(moves);
        const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
        return std::sqrt(sum / static_cast<double>(sketch_.of));
    }

    /// Moves points to where they explain the scan. @param noise of the scan [input length]
    /// @returns the share of the points that was deconvolved
    double deconvolve_all(double noise, const Execution& execution) {
        // Tiles see where the points around them were before; few are moved, as most are flat.
        std::vector<std::vector<Deconvolved>> bent(tiles_.size());
        for_each_tile("deconvolve", execution, [&](std::size_t tile, const Execution& alone) {
            const Box& box = partition_.boxes()[tile];
            const std::span<const std::uint32_t> indices = tiles_.points(tile);
            const Points scan = load(indices);
            Points now = moved(scan, indices).cloud.points;
            for (const std::uint32_t i : deconvolve(scan, noise, {box}, now, alone)) {
                if (!box.holds(scan.col(i))) continue;
                bent[tile].push_back({indices[i], (now.col(i) - scan.col(i)).cast<float>()});
            }
            bent[tile].shrink_to_fit();
        });
        std::size_t count = 0;
        for (const std::vector<Deconvolved>& points : bent) {
            for (const Deconvolved& point : points) moves_[point.index] = point.move;
            count += points.size();
        }
        return static_cast<double>(count) / static_cast<double>(sketch_.of);
    }

    /// Calls body(tile, execution) for some tiles at a time.
    template <typename Body>
    void for_each_tile(std::string_view phase, const Execution& execution, const Body& body) {
        JoinedProgress progress(execution, phase, "tiles", tiles_.size());
        const int at_once = std::min(execution.threads, kTilesAtOnce);
        Execution together = execution;
        together.threads = at_once;
        parallel_for(together, tiles_.size(), 1, [&](std::size_t tile, std::size_t, std::size_t) {
            body(tile, progress.part(std::max(1, execution.threads / at_once)));
            source_.let_go();
        });
    }

    /// Moves the points that lie in a tile. @returns the LPFs there
    AnalysisResult move_tile(std::size_t tile, std::vector<Eigen::Vector3f>& moves, double& squares,
                             const Execution& execution) {
        const Box& box = partition_.boxes()[tile];
        const std::span<const std::uint32_t> indices = tiles_.points(tile);
        const Points original = load(indices);
        if (counts_duplicates_ && moves_.empty())
            duplicates_ += count_duplicates(original, box, execution);
        const auto move_own = [&](const std::vector<std::uint32_t>& order, const Moves& found) {
            const double step = step_length(params_);
            for (std::size_t i = 0; i < order.size(); ++i) {
                if (!box.holds(original.col(order[i]))) continue;
                const Eigen::Vector3d move = step * found[i].cast<double>();
                moves[indices[order[i]]] += move.cast<float>();
                squares += move.squaredNorm();
            }
        };
        DenoiseParams params = params_;
        params.analysis.keep_dictionary = true;
        AnalysisResult part =
            find_moves(moved(original, indices), params, {box}, execution, move_own);
        keep_own(box, part);
        return part;
    }

    const PointSource& source_;
    DenoiseParams params_;
    Sketch sketch_;
    Partition partition_;
    Tiling tiles_;
    Excerpt excerpt_;
    bool counts_duplicates_;
    std::vector<Eigen::Vector3f> moves_;  // so far; empty in the first iteration
    std::atomic<std::size_t> duplicates_{0};
};

}  // namespace

TiledDenoising denoise_tiles(const PointSource& source, const DenoiseParams& params,
                             const Execution& execution, const TilingParams& tiling) {
    validate(params);
    return TiledDenoiser(source, params, tiling, execution).run(execution);
}

}  // namespace lpf

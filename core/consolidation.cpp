#include "core/consolidation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/blocks.h"
#include "core/count_sample.h"
#include "core/spacing_search.h"

namespace lpf {
namespace {

constexpr double kCountTolerance = 0.02;
constexpr double kTrialTolerance = 0.005;  // of the number that a sample foretells
constexpr int kMostSearchRounds = 8;
constexpr int kMostPasses = 4;

/// Candidates of a block about, at most: with all that is worked on, 75 bytes each.
constexpr double kCandidatesOfBlock = 1.5e6;

/// So few candidates of a search are held as a whole: making them again and again takes longer.
constexpr double kCandidatesOfSearch = 6e6;

/// After so many tries of a search the places stay, so that the number of points changes with the
/// spacing alone: a finer lattice of places makes a denser packing.
constexpr int kTriesOfPlaces = 2;

/// Steps of unknown number, each a share of what is left of a progress bar.
class Steps {
public:
    explicit Steps(const Execution& execution) : execution_(execution) {}

    Execution next(double share_of_rest) {
        const double begin = done_;
        done_ += share_of_rest * (1 - done_);
        return part_of(execution_, begin, done_);
    }

private:
    const Execution& execution_;
    double done_ = 0.0;
};

}  // namespace

/// First guess of tau_p for a number of points, from the area that the disks of all LPFs suggest:
/// seeds are a packing themselves.
double Consolidation::guess_spacing() const {
    const double seeds_apart = std::max(params_.analysis.seed_spacing, 0.05);
    double area = 0.0;
    for (const Frame& frame : fields_.frames) {
        area += seeds_apart * seeds_apart * frame.radius * frame.radius;
    }
    return std::sqrt(area / static_cast<double>(params_.target_points));
}

Candidates Consolidation::all_candidates(const Execution& execution) const {
    std::vector<std::uint32_t> all(fields_.size());
    std::iota(all.begin(), all.end(), 0U);
    return proposer_->propose(all, CellLattice{}.space_of(CellLattice::everything()), execution);
}

bool Consolidation::is_small() const {
    return proposer_->mean_places() * static_cast<double>(fields_.size()) <= kCandidatesOfSearch;
}

/// Its cells lie around the middle of the LPFs, wherever a stray point may be.
Consensus Consolidation::empty_consensus(double spacing) const {
    return {fields_.frames[fields_.size() / 2].centre, spacing};
}

/// All LPFs, block by block.
Consensus Consolidation::pass(double spacing, const Execution& execution) const {
    Consensus consensus = empty_consensus(spacing);
    const auto most = static_cast<std::size_t>(kCandidatesOfBlock / proposer_->mean_places());
    const std::vector<Block> blocks = divide(fields_.frames, consensus.cells(), spacing, most);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const Execution part = step_of(execution, b, blocks.size());
        const Eigen::AlignedBox3d space = consensus.cells().space_of(blocks[b].box);
        const Candidates candidates = proposer_->propose(
            blocks[b].fields, widened(space, 1.01 * spacing), part_of(part, 0.0, 0.7));
        consensus.settle(candidates, blocks[b].box, part_of(part, 0.7, 1.0));
    }
    return consensus;
}

Consolidation::Found Consolidation::find(const Execution& execution) {
    const bool search = params_.target_points > 0;
    const double spacing = search ? guess_spacing() : params_.target_spacing;
    place(spacing);
    if (!search) return {pass(spacing, execution), spacing};
    return is_small() ? search_on_all(execution) : search_on_sample(execution);
}

Consolidation::Found Consolidation::search_on_all(const Execution& execution) {
    SpacingSearch search(guess_spacing(), static_cast<double>(params_.target_points));
    Steps steps(execution);
    Candidates candidates;
    for (int round = 0;; ++round) {
        const double spacing = search.spacing();
        if (round < kTriesOfPlaces) {
            place(spacing);
            candidates = all_candidates(steps.next(0.4));
        }
        Consensus consensus = empty_consensus(spacing);
        consensus.settle(candidates, CellLattice::everything(), steps.next(0.4));
        const auto count = static_cast<double>(consensus.size());
        if (search.accepts(count, kCountTolerance / 2) || round + 1 == kMostSearchRounds) {
            return {std::move(consensus), spacing};
        }
    }
}

/// Spacings are tried on a sample; then all LPFs show how far the sample is off.
Consolidation::Found Consolidation::search_on_sample(const Execution& execution) {
    const auto wanted = static_cast<double>(params_.target_points);
    Steps steps(execution);
    std::optional<CountSample> sample;
    double wanted_of_sample = wanted;
    double spacing = guess_spacing();
    int tries = 0;
    for (int passes = 1;; ++passes) {
        SpacingSearch search(spacing, wanted_of_sample);
        for (int round = 0; round < kMostSearchRounds; ++round) {
            spacing = search.spacing();
            if (tries++ < kTriesOfPlaces) {
                place(spacing);
                sample.emplace(fields_, *proposer_, spacing, steps.next(0.1));
            }
            const double count = sample->count(spacing, steps.next(0.03));
            if (search.accepts(count, kTrialTolerance)) break;
        }
        Consensus consensus = pass(spacing, steps.next(0.9));
        const auto count = static_cast<double>(consensus.size());
        if (std::abs(count - wanted) <= kCountTolerance * wanted || passes == kMostPasses) {
            return {std::move(consensus), spacing};
        }
        wanted_of_sample *= wanted / std::max(1.0, count);
    }
}

}  // namespace lpf

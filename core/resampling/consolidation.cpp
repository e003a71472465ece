#include "core/resampling/consolidation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/resampling/blocks.h"
#include "core/resampling/count_sample.h"
#include "core/resampling/spacing_search.h"

namespace lpf {
namespace {

constexpr double kCountTolerance = 0.01;
constexpr double kTrialTolerance = 0.005;  // of the number that a sample foretells
constexpr int kMostSearchRounds = 8;

/// Candidates of a block about, at most: with all that is worked on, 75 bytes each.
constexpr double kCandidatesOfBlock = 1.5e6;

/// So few candidates of a search are held as a whole: making them again and again takes longer.
constexpr double kCandidatesOfSearch = 2.5e6;

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

/// The places of LPFs stay while spacings are tried, so that the number of points changes with the
/// spacing alone.
Consolidation::Found Consolidation::find(const Execution& execution) {
    const bool search = params_.target_points > 0;
    const double spacing = search ? guess_spacing() : params_.target_spacing;
    proposer_.emplace(fields_, analysis_, params_, spacing);
    if (!search) return find_again(spacing, execution);
    return is_small() ? search_on_all(spacing, execution) : search_on_sample(spacing, execution);
}

Consolidation::Found Consolidation::find_again(double spacing, const Execution& execution) const {
    return {pass(spacing, execution), spacing};
}

Consolidation::Found Consolidation::search_on_all(double guess, const Execution& execution) const {
    SpacingSearch search(guess, static_cast<double>(params_.target_points));
    Steps steps(execution);
    const Candidates candidates = all_candidates(steps.next(0.4));
    for (int round = 1;; ++round) {
        const double spacing = search.spacing();
        Consensus consensus = empty_consensus(spacing);
        consensus.settle(candidates, CellLattice::everything(), steps.next(0.5));
        const auto count = static_cast<double>(consensus.size());
        if (search.accepts(count, kCountTolerance) || round == kMostSearchRounds) {
            return {std::move(consensus), spacing};
        }
    }
}

Consolidation::Found Consolidation::search_on_sample(double guess,
                                                     const Execution& execution) const {
    const auto wanted = static_cast<double>(params_.target_points);
    Steps steps(execution);
    const CountSample sample(fields_, *proposer_, guess, wanted, steps.next(0.1));
    SpacingSearch search(guess, wanted);
    for (int round = 1; round < kMostSearchRounds; ++round) {
        const double count = sample.count(search.spacing(), steps.next(0.03));
        if (search.accepts(count, kTrialTolerance)) break;
    }
    return find_again(search.spacing(), steps.next(1.0));
}

}  // namespace lpf

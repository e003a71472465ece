#include "core/denoising/votes.h"

#include "core/denoising/ballot.h"
#include "core/denoising/voter.h"

namespace lpf {
namespace {

/// A vote to move by this many sigma counts 0.62 times one to stay: in the first round, and in the
/// second. Narrower ones tell crossing curves apart better, but hold back more of noise that is
/// stronger than it was measured.
constexpr double kFirstWidth = 0.95;
constexpr double kSecondWidth = 0.45;

/// One round of votes.
class Round {
public:
    /// @param params  of the votes
    /// @param before  what the round before has decided; null in the first
    /// @param width   of the likely moves [input length]; 0 = any move is likely
    /// @param fits    one for each LPF; the first round measures them
    Round(const FieldSet& fields, const AnalysisResult& analysis, const VoteParams& params,
          const Moves* before, double width, std::vector<Fit>& fits)
        : fields_(fields),
          voter_(fields, analysis, params.sharp, width),
          before_(before),
          slides_(params.slides && !before),
          fits_(fits) {}

    void run(Ballot& ballot, const Execution& execution) const {
        fields_.for_each_ball("vote", execution,
                              [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
                                  if (fields_.dimensions[j] != kTooFewPoints) {
                                      vote(j, worker, ballot);
                                  }
                              });
    }

private:
    void vote(std::size_t j, FieldSet::Worker& worker, Ballot& ballot) const {
        TargetArea& target = worker.probe.target;
        if (before_) move_as_decided(j, target);
        Arrows field = Voter::field_at(target, voter_.image(j, worker));
        if (!before_) fits_[j] = voter_.fit(j, target, field);
        if (fits_[j].is_plain) Voter::leave_only_sliding(fields_.pieces[j], field);
        // Once is enough for what pulls points from beyond a border or an end.
        if (!slides_) Voter::stop_sliding(fields_.pieces[j], field);
        voter_.cast(j, target, field, {fits_[j].misfit, voter_.density(j, target)}, ballot);
    }

    /// Moves the points of a flattened target area to where the round before has put them.
    void move_as_decided(std::size_t j, TargetArea& target) const {
        Arrows moves(target.size);
        for (std::size_t i = 0; i < target.size; ++i) {
            const Eigen::Vector3f& move = (*before_)[target.index[i]];
            moves.x[i] = move.x();
            moves.y[i] = move.y();
            moves.z[i] = move.z();
        }
        moves.rotate(fields_.frames[j].axes.transpose() / voter_.size_of(j));
        add_mean_change(fields_.pieces[j], -1.0F, target.x.data(), target.y.data(), moves.x.data(),
                        moves.y.data(), target.size, target.y.data(), target.z.data());
        for (std::size_t i = 0; i < target.size; ++i) {
            target.x[i] += moves.x[i];
            target.y[i] += moves.y[i];
            target.z[i] += moves.z[i];
        }
    }

    const FieldSet& fields_;
    Voter voter_;
    const Moves* before_;
    bool slides_;
    std::vector<Fit>& fits_;
};

}  // namespace

Moves vote(const FieldSet& fields, const AnalysisResult& analysis, const VoteParams& params,
           const Execution& execution) {
    std::vector<Fit> fits(fields.size());
    const auto decide = [&](const Moves* before, double width, const Execution& part) {
        Ballot ballot(fields.grid().size(), execution);
        Round(fields, analysis, params, before, width, fits).run(ballot, part);
        Moves moves(fields.grid().size());
        parallel_for(execution, moves.size(), kPointsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         for (std::size_t i = begin; i < end; ++i) {
                             moves[i] = ballot.outcome(i).cast<float>();
                             if (before) moves[i] += (*before)[i];
                         }
                     });
        return moves;
    };
    Moves first = decide(nullptr, kFirstWidth * params.noise, part_of(execution, 0.0, 0.5));
    if (params.noise <= 0) return first;
    return decide(&first, kSecondWidth * params.noise, part_of(execution, 0.5, 1.0));
}

}  // namespace lpf

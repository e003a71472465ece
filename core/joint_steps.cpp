#include "core/joint_steps.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/kernels.h"
#include "core/learn/pose.h"

namespace lpf {
namespace {

double l1_norm(std::span<const float> code) {
    double sum = 0.0;
    for (const float value : code) sum += std::abs(static_cast<double>(value));
    return sum;
}

/// |V - D alpha|^2 of one.
float squared_distance(const FieldBlock& block, std::size_t i) {
    return kernels::squared_distance(block.field(i).data(), block.decoded_field(i).data(),
                                     block.field(i).size());
}

/// Correlations of one with the atoms.
std::span<const float> correlations_of(const FieldBlock& block, std::size_t i, std::size_t d) {
    return block.correlations.subspan(i * whole_lines(d), d);
}

}  // namespace

BlockRoom::BlockRoom(std::size_t stride, std::size_t d)
    : decoded_(kFieldsOfBlock * stride),
      correlations_(kFieldsOfBlock * whole_lines(d)),
      codes_(kFieldsOfBlock * d) {}

FieldBlock BlockRoom::block(std::span<const std::size_t> numbers, std::span<float> fields) {
    const auto some = [&](AlignedFloats& all) {
        return std::span(all).first(all.size() / kFieldsOfBlock * numbers.size());
    };
    return {numbers, fields, some(decoded_), some(correlations_), some(codes_)};
}

JointSteps::JointSteps(FieldSet& fields, const AnalysisParams& params, int atoms)
    : codes(fields.size(), atoms),
      residuals(fields.size(), 0.0F),
      fields_(fields),
      params_(params),
      coder_{static_cast<float>(params.lambda), params.lasso} {}

void JointSteps::close(const Iteration& last, const FieldBlock& block, IterationEnergy& sum) const {
    if (last.number < 0) return;
    decode(*last.matrices, block);
    for (std::size_t i = 0; i < block.count(); ++i) sum.probing += energy(block, i);
}

void JointSteps::iterate(const Iteration& iteration, const FieldBlock& block,
                         IterationEnergy& sum) {
    encode(*iteration.matrices, block);
    decode(*iteration.matrices, block);
    for (std::size_t i = 0; i < block.count(); ++i) {
        const double learned = energy(block, i);
        sum.learning += learned;
        const bool stays = iteration.closes || fields_.pose_is_fixed(block.number[i]);
        if (!stays) move_to_fit(block, i);
        sum.pose += stays ? learned : energy(block, i);
    }
    if (iteration.closes) finish(iteration, block);
}

/// D alpha of each.
void JointSteps::decode(const CodingMatrices& matrices, const FieldBlock& block) const {
    auto to = block.codes.begin();
    for (const std::size_t j : block.number) to = std::ranges::copy(codes[j], to).out;
    Coder::decode(matrices, block.codes, block.decoded);
}

void JointSteps::encode(const CodingMatrices& matrices, const FieldBlock& block) {
    Coder::correlate(matrices, block.fields, block.correlations);
    std::array<LassoTask, kFieldsOfBlock> tasks;
    for (std::size_t i = 0; i < block.count(); ++i) {
        const std::size_t j = block.number[i];
        tasks[i] = {correlations_of(block, i, matrices.d), coder_.lambda * fields_.lambda_share(j),
                    codes[j]};
    }
    coder_.solve(matrices.gram, std::span(tasks).first(block.count()));
}

/// Moves LPF and field to where they fit the code best.
void JointSteps::move_to_fit(const FieldBlock& block, std::size_t i) {
    float* const field = block.field(i).data();
    const RigidFit fit = fit_pose(fields_.pattern(), field, block.decoded_field(i).data());
    apply_pose(fit, fields_.frames[block.number[i]]);
    move_field(fields_.pattern(), fit, field);
}

/// The codes as they are to be, and what they leave of the fields.
void JointSteps::finish(const Iteration& iteration, const FieldBlock& block) {
    const CodingMatrices& matrices = *iteration.matrices;
    if (params_.debias) {
        for (std::size_t i = 0; i < block.count(); ++i) {
            debias({matrices.gram, correlations_of(block, i, matrices.d), 0.0F},
                   codes[block.number[i]]);
        }
        decode(matrices, block);
    }
    const auto nodes = static_cast<float>(fields_.pattern().size());
    for (std::size_t i = 0; i < block.count(); ++i) {
        residuals[block.number[i]] = std::sqrt(squared_distance(block, i) / nodes);
    }
}

/// Eq. 2 of one LPF, |V - D alpha|^2 + lambda |alpha|_1.
double JointSteps::energy(const FieldBlock& block, std::size_t i) const {
    const std::size_t j = block.number[i];
    return static_cast<double>(squared_distance(block, i)) +
           params_.lambda * static_cast<double>(fields_.lambda_share(j)) * l1_norm(codes[j]);
}

}  // namespace lpf

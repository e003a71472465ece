#include "core/learn/dictionary_learning.h"

#include <algorithm>
#include <array>

#include "core/base/kernels.h"
#include "core/base/random.h"

namespace lpf {
namespace {

constexpr std::size_t kFieldsPerChunk = 256;

/// Fields of a sample that are coded together. They come from far, and the dictionary is read once
/// for all of them.
constexpr std::size_t kFieldsAtOnce = 32;

/// Codes the whole sample, and sums up what the dictionary update needs, chunk by chunk in order.
DictionaryStatistics encode_sample(const FieldSample& sample, const Coder& coder,
                                   const Dictionary& dictionary, SparseCodes& codes,
                                   const Execution& execution) {
    const CodingMatrices matrices(dictionary);
    std::vector<DictionaryStatistics> parts(
        chunk_count(sample.count(), kFieldsPerChunk),
        DictionaryStatistics(dictionary.atoms(), dictionary.stride()));
    parallel_for(execution, "learn", "fields", sample.count(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     const auto d = static_cast<std::size_t>(dictionary.atoms());
                     AlignedFloats correlations(kFieldsAtOnce * matrices.width);
                     std::array<LassoTask, kFieldsAtOnce> tasks;
                     for (std::size_t first = begin; first < end; first += kFieldsAtOnce) {
                         const std::size_t size = std::min(kFieldsAtOnce, end - first);
                         const std::span<const float> fields = sample.some(first, size);
                         Coder::correlate(matrices, fields, correlations);
                         for (std::size_t k = 0; k < size; ++k) {
                             tasks[k] = {std::span(correlations).subspan(k * matrices.width, d),
                                         coder.lambda * sample.share_of(first + k),
                                         codes[first + k]};
                         }
                         coder.solve(matrices.gram, std::span(tasks).first(size));
                         parts[chunk].add(codes.some(first, size), fields);
                     }
                 });
    for (std::size_t c = 1; c < parts.size(); ++c) parts[0].add(parts[c]);
    return std::move(parts.front());
}

}  // namespace

CodingMatrices::CodingMatrices(const Dictionary& dictionary)
    : gram(dictionary.gram()),
      atoms(dictionary.panels()),
      transposed(dictionary.transposed_panels()),
      stride(dictionary.stride()),
      width(whole_lines(static_cast<std::size_t>(dictionary.atoms()))),
      d(static_cast<std::size_t>(dictionary.atoms())) {}

void Coder::encode(const CodingMatrices& matrices, std::span<const float> field,
                   std::span<float> code, float lambda_share) const {
    AlignedFloats correlations(matrices.width);
    correlate(matrices, field, correlations);
    const LassoTask task{correlations, lambda * lambda_share, code};
    solve(matrices.gram, {&task, 1});
}

void Coder::correlate(const CodingMatrices& matrices, std::span<const float> fields,
                      std::span<float> correlations) {
    kernels::multiply(fields.data(), fields.size() / matrices.stride, matrices.stride,
                      matrices.transposed.data(), matrices.width, correlations.data());
}

void Coder::decode(const CodingMatrices& matrices, std::span<const float> codes,
                   std::span<float> out) {
    kernels::multiply(codes.data(), codes.size() / matrices.d, matrices.d, matrices.atoms.data(),
                      matrices.stride, out.data());
}

void Coder::solve(std::span<const float> gram, std::span<const LassoTask> tasks) const {
    if (method == LassoMethod::Lars) {
        for (const LassoTask& task : tasks) {
            solve_lars({gram, task.correlations, task.lambda}, task.code);
        }
    } else {
        solve_coordinate_descent(gram, tasks);
    }
}

Dictionary draw_dictionary(const Pattern& pattern, int atoms, const FieldSample& sample,
                           std::uint64_t random_seed) {
    Dictionary dictionary(pattern, atoms);
    Random random(random_seed, 0xd1c7);
    for (int k = 0; k < atoms && sample.count() > 0; ++k) {
        set_atom(dictionary, k, sample[random.below(sample.count())]);
    }
    return dictionary;
}

void learn_dictionary(const FieldSample& sample, const Coder& coder, int rounds,
                      std::uint64_t random_seed, Dictionary& dictionary, SparseCodes& codes,
                      const Execution& execution) {
    if (sample.count() == 0) return;
    Random random(random_seed, 0x1ea2);
    for (int round = 0; round < rounds; ++round) {
        const Execution part =
            step_of(execution, static_cast<std::size_t>(round), static_cast<std::size_t>(rounds));
        const DictionaryStatistics statistics =
            encode_sample(sample, coder, dictionary, codes, part);
        for (const int atom : statistics.update(dictionary)) {
            set_atom(dictionary, atom, sample[random.below(sample.count())]);
        }
    }
}

}  // namespace lpf

#include "core/learn/dictionary_learning.h"

#include <algorithm>
#include <array>

#include "core/base/kernels.h"
#include "core/base/random.h"

namespace lpf {
namespace {

constexpr std::size_t kFieldsPerChunk = 256;

/// Codes the whole sample, and sums up what the dictionary update needs, chunk by chunk in order.
DictionaryStatistics encode_sample(const FieldSample& sample, const Coder& coder,
                                   const Dictionary& dictionary, SparseCodes& codes,
                                   const Execution& execution) {
    const std::vector<float> gram = dictionary.gram();
    std::vector<DictionaryStatistics> parts(
        chunk_count(sample.count(), kFieldsPerChunk),
        DictionaryStatistics(dictionary.atoms(), dictionary.stride()));
    parallel_for(execution, "learn", "fields", sample.count(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     const auto d = static_cast<std::size_t>(dictionary.atoms());
                     std::vector<float> correlations(kFieldsOfBlock * d);
                     std::array<LassoTask, kFieldsOfBlock> tasks;
                     for (std::size_t first = begin; first < end; first += kFieldsOfBlock) {
                         const std::size_t size = std::min(kFieldsOfBlock, end - first);
                         Coder::correlate(dictionary, sample.some(first, size), correlations);
                         for (std::size_t k = 0; k < size; ++k) {
                             tasks[k] = {std::span(correlations).subspan(k * d, d),
                                         coder.lambda * sample.share_of(first + k),
                                         codes[first + k]};
                         }
                         coder.solve(gram, std::span(tasks).first(size));
                         for (std::size_t i = first; i < first + size; ++i) {
                             parts[chunk].add(codes[i], sample[i]);
                         }
                     }
                 });
    for (std::size_t c = 1; c < parts.size(); ++c) parts[0].add(parts[c]);
    return std::move(parts.front());
}

}  // namespace

void Coder::encode(const Dictionary& dictionary, std::span<const float> gram,
                   std::span<const float> field, std::span<float> correlations,
                   std::span<float> code, float lambda_share) const {
    correlate(dictionary, field, correlations);
    const LassoTask task{correlations, lambda * lambda_share, code};
    solve(gram, {&task, 1});
}

void Coder::correlate(const Dictionary& dictionary, std::span<const float> fields,
                      std::span<float> correlations) {
    const auto d = static_cast<std::size_t>(dictionary.atoms());
    const std::size_t stride = dictionary.stride();
    if (fields.size() == stride) {
        kernels::multiply_rows(dictionary.data(), d, stride, fields.data(), correlations.data());
    } else {
        kernels::multiply_rows_with_all(dictionary.data(), d, stride, fields.data(),
                                        fields.size() / stride, correlations.data());
    }
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

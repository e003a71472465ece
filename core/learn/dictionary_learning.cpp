#include "core/learn/dictionary_learning.h"

#include <algorithm>

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
    parallel_for(
        execution, "learn", "fields", sample.count(), kFieldsPerChunk,
        [&](std::size_t begin, std::size_t end, std::size_t chunk) {
            const auto d = static_cast<std::size_t>(dictionary.atoms());
            std::vector<float> correlations(kFieldsOfBlock * d);
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t k = (i - begin) % kFieldsOfBlock;
                if (k == 0) {
                    const std::size_t size = std::min(kFieldsOfBlock, end - i);
                    Coder::correlate(dictionary, sample.some(i, size), correlations);
                }
                const float share = sample.lambda_share.empty() ? 1.0F : sample.lambda_share[i];
                coder.solve(gram, std::span(correlations).subspan(k * d, d), codes[i], share);
                parts[chunk].add(codes[i], sample[i]);
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
    solve(gram, correlations, code, lambda_share);
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

void Coder::solve(std::span<const float> gram, std::span<const float> correlations,
                  std::span<float> code, float lambda_share) const {
    const LassoProblem problem{gram, correlations, lambda * lambda_share};
    if (method == LassoMethod::Lars) {
        solve_lars(problem, code);
    } else {
        solve_coordinate_descent(problem, code);
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
        const Execution part = part_of(execution, static_cast<double>(round) / rounds,
                                       static_cast<double>(round + 1) / rounds);
        const DictionaryStatistics statistics =
            encode_sample(sample, coder, dictionary, codes, part);
        for (const int atom : statistics.update(dictionary)) {
            set_atom(dictionary, atom, sample[random.below(sample.count())]);
        }
    }
}

}  // namespace lpf

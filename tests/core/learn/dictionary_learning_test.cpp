#include "core/learn/dictionary_learning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

using Floats = std::vector<float>;

const Pattern kPattern = Pattern::grid(4);
const std::size_t kStride = 3 * static_cast<std::size_t>(kPattern.padded_size());

/// `count` random fields; those from `turn` on are of another kind.
FieldSample random_sample(std::size_t count, std::uint64_t seed, std::size_t turn = 0) {
    FieldSample sample{AlignedFloats(count * kStride, 0.0F), kStride, {}};
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < kStride; ++k) {
            const double kind = (i < turn) == (k % 2 == 0) ? 1.0 : 0.2;
            sample.fields[i * kStride + k] = static_cast<float>(kind * random.normal());
        }
    }
    return sample;
}

std::vector<float> all_values(const Dictionary& dictionary) {
    return {dictionary.data(),
            dictionary.data() + static_cast<std::size_t>(dictionary.atoms()) * kStride};
}

/// Mean of Eq. 2 over the sample.
double energy(const FieldSample& sample, const Dictionary& dictionary, const SparseCodes& codes,
              double lambda) {
    double sum = 0;
    Floats decoded(kStride);
    for (std::size_t i = 0; i < sample.count(); ++i) {
        dictionary.decode(codes[i], decoded);
        for (std::size_t k = 0; k < kStride; ++k) {
            sum += std::pow(double{sample[i][k]} - double{decoded[k]}, 2);
        }
        for (const float value : codes[i]) sum += lambda * std::abs(double{value});
    }
    return sum / static_cast<double>(sample.count());
}

Floats encoded(const Coder& coder, const Dictionary& dictionary, std::span<const float> field,
               float share = 1.0F) {
    Floats code(static_cast<std::size_t>(dictionary.atoms()), 0.0F);
    coder.encode(CodingMatrices(dictionary), field, code, share);
    return code;
}

TEST(LearnDictionary, IsTheUpdateOfTheCodesOfTheWholeSample) {
    const FieldSample sample = random_sample(600, 1, 300);  // more than two chunks
    Dictionary learned = draw_dictionary(kPattern, 4, sample, 5);
    Dictionary expected = learned;
    const Coder coder{0.5F};

    DictionaryStatistics statistics(4, kStride);
    for (std::size_t i = 0; i < sample.count(); ++i) {
        statistics.add(encoded(coder, expected, sample[i]), sample[i]);
    }
    ASSERT_TRUE(statistics.update(expected).empty());

    SparseCodes codes(sample.count(), 4);
    learn_dictionary(sample, coder, 1, 5, learned, codes, {});
    for (int k = 0; k < 4; ++k) {
        for (std::size_t i = 0; i < kStride; ++i) {
            ASSERT_NEAR(learned.atom(k)[i], expected.atom(k)[i], 1e-4);
        }
    }
}

TEST(LearnDictionary, EveryRoundLowersTheEnergy) {
    const FieldSample sample = random_sample(100, 2);
    const Coder coder{0.3F};
    double last = 1e30;
    for (int rounds = 1; rounds <= 4; ++rounds) {
        Dictionary dictionary = draw_dictionary(kPattern, 6, sample, 5);
        SparseCodes codes(sample.count(), 6);
        learn_dictionary(sample, coder, rounds, 5, dictionary, codes, {});
        const double now = energy(sample, dictionary, codes, coder.lambda);
        EXPECT_LT(now, last) << rounds << " rounds";
        last = now;
    }
}

TEST(LearnDictionary, DrawsUnusedAtomsAnew) {
    const FieldSample sample = random_sample(50, 3);
    Dictionary dictionary(kPattern, 2);
    set_atom(dictionary, 0, sample[0]);  // the other atom is zero: no code uses it
    SparseCodes codes(sample.count(), 2);
    learn_dictionary(sample, {0.1F}, 1, 5, dictionary, codes, {});
    const auto atom = dictionary.atom(1);
    EXPECT_TRUE(std::ranges::any_of(atom, [](float value) { return value != 0; }));
}

TEST(DrawDictionary, DependsOnTheSeedAndOnNothingElse) {
    const FieldSample sample = random_sample(500, 4);
    const auto once = all_values(draw_dictionary(kPattern, 8, sample, 1));
    EXPECT_EQ(all_values(draw_dictionary(kPattern, 8, sample, 1)), once);
    EXPECT_NE(all_values(draw_dictionary(kPattern, 8, sample, 2)), once);
}

TEST(Coder, UsesTheMethodThatItIsToldTo) {
    const FieldSample sample = random_sample(40, 6);
    const Dictionary dictionary = draw_dictionary(kPattern, 12, sample, 1);
    const CodingMatrices matrices(dictionary);
    for (std::size_t i = 0; i < sample.count(); ++i) {
        Floats correlations(matrices.width);
        Floats code(12, 0.5F);
        const Coder coder{0.2F, LassoMethod::Lars};
        coder.encode(matrices, sample[i], code);
        Coder::correlate(matrices, sample[i], correlations);
        Floats expected(12);
        solve_lars({matrices.gram, correlations, 0.2F}, expected);
        ASSERT_EQ(code, expected) << "the same solver gives the same bits";
    }
}

TEST(Coder, TakesItsShareOfLambda) {
    const FieldSample sample = random_sample(20, 7);
    const Dictionary dictionary = draw_dictionary(kPattern, 8, sample, 1);
    for (std::size_t i = 0; i < sample.count(); ++i) {
        EXPECT_EQ(encoded({0.1F}, dictionary, sample[i], 4.0F),
                  encoded({0.4F}, dictionary, sample[i]));
    }
}

TEST(LearnDictionary, GivesEachFieldItsShareOfLambda) {
    FieldSample sample = random_sample(30, 8);
    const Dictionary start = draw_dictionary(kPattern, 5, sample, 1);
    const auto codes_with = [&](const std::vector<float>& shares, float lambda) {
        sample.lambda_share = shares;
        Dictionary dictionary = start;
        SparseCodes codes(sample.count(), 5);
        learn_dictionary(sample, {lambda}, 1, 1, dictionary, codes, {});
        Floats flat;
        for (std::size_t i = 0; i < codes.size(); ++i) {
            flat.insert(flat.end(), codes[i].begin(), codes[i].end());
        }
        return flat;
    };
    EXPECT_EQ(codes_with(std::vector<float>(30, 8.0F), 0.25F), codes_with({}, 2.0F));
}

TEST(DictionaryUpdate, MovesAtomsThatAreUsedALittle) {
    const FieldSample sample = random_sample(1, 9);
    Dictionary dictionary(kPattern, 1);
    Floats other(kStride, 0.0F);
    other[0] = 1.0F;
    set_atom(dictionary, 0, other);
    DictionaryStatistics statistics(1, kStride);
    statistics.add(Floats{0.01F}, sample[0]);
    EXPECT_TRUE(statistics.update(dictionary).empty());
    Dictionary expected(kPattern, 1);
    set_atom(expected, 0, sample[0]);
    for (std::size_t i = 0; i < kStride; ++i) {
        EXPECT_NEAR(dictionary.atom(0)[i], expected.atom(0)[i], 1e-4);
    }
}

}  // namespace
}  // namespace lpf

#include "core/learn/dictionary.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/learn/dictionary_learning.h"

namespace lpf {
namespace {

using Floats = std::vector<float>;

Floats random_floats(std::size_t n, Random& random) {
    Floats values(n);
    for (float& value : values) value = static_cast<float>(random.normal());
    return values;
}

/// A field over the pattern: padding zero, as probing leaves it.
Floats random_field(const Pattern& pattern, Random& random) {
    Floats field(3 * static_cast<std::size_t>(pattern.padded_size()), 0.0F);
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < pattern.size(); ++i) {
            field[static_cast<std::size_t>(c * pattern.padded_size() + i)] =
                static_cast<float>(random.normal());
        }
    }
    return field;
}

Dictionary random_dictionary(int atoms, std::uint64_t seed) {
    const Pattern pattern = Pattern::grid(8);
    Dictionary dictionary(pattern, atoms);
    Random random(seed);
    for (int k = 0; k < atoms; ++k) set_atom(dictionary, k, random_field(pattern, random));
    return dictionary;
}

double norm(std::span<const float> field) {
    double sum = 0;
    for (const float value : field) sum += double{value} * value;
    return std::sqrt(sum);
}

/// |V - D a|^2 of one field.
double misfit(const Dictionary& dictionary, std::span<const float> field,
              std::span<const float> code) {
    double sum = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        double value = field[i];
        for (int k = 0; k < dictionary.atoms(); ++k) {
            value -= double{code[static_cast<std::size_t>(k)]} * dictionary.atom(k)[i];
        }
        sum += value * value;
    }
    return sum;
}

/// Sparse combinations of three hidden atoms.
FieldSample hidden_sample(std::size_t count, std::uint64_t seed) {
    const Dictionary hidden = random_dictionary(3, 99);
    FieldSample sample;
    sample.stride = hidden.stride();
    Random random(seed);
    for (std::size_t i = 0; i < count; ++i) {
        Floats code(3, 0.0F);
        code[random.below(3)] = static_cast<float>(random.uniform(1, 3));
        Floats field(hidden.stride());
        hidden.decode(code, field);
        for (float& value : field) {
            if (value != 0) value += static_cast<float>(0.005 * random.normal());
        }
        sample.fields.insert(sample.fields.end(), field.begin(), field.end());
    }
    return sample;
}

/// Eq. 2 of a sample.
double energy(const FieldSample& sample, const Dictionary& dictionary, const SparseCodes& codes,
              float lambda) {
    double sum = 0;
    for (std::size_t i = 0; i < sample.count(); ++i) {
        sum += misfit(dictionary, sample[i], codes[i]);
        for (const float value : codes[i]) sum += double{lambda} * std::abs(value);
    }
    return sum;
}

TEST(Dictionary, StartsAtZeroWithRoomForEveryChannel) {
    const Dictionary dictionary(Pattern::grid(16), 5);
    EXPECT_EQ(dictionary.atoms(), 5);
    EXPECT_EQ(dictionary.stride(), 3U * 208U);
    for (int k = 0; k < 5; ++k) EXPECT_EQ(norm(dictionary.atom(k)), 0);
}

TEST(Dictionary, DecodeIsTheLinearCombinationOfItsAtoms) {
    const Dictionary dictionary = random_dictionary(9, 1);
    Random random(2);
    Floats code = random_floats(9, random);
    code[3] = 0;
    Floats out(dictionary.stride(), 55.0F);
    dictionary.decode(code, out);
    EXPECT_LT(misfit(dictionary, out, code), 1e-9);
    dictionary.decode(Floats(9, 0.0F), out);
    EXPECT_EQ(norm(out), 0);
}

TEST(Dictionary, GramHoldsTheProductsOfItsAtoms) {
    const Dictionary dictionary = random_dictionary(7, 3);
    const Floats gram = dictionary.gram();
    ASSERT_EQ(gram.size(), 49U);
    for (int a = 0; a < 7; ++a) {
        for (int b = 0; b < 7; ++b) {
            double expected = 0;
            for (std::size_t i = 0; i < dictionary.stride(); ++i) {
                expected += double{dictionary.atom(a)[i]} * dictionary.atom(b)[i];
            }
            EXPECT_NEAR(gram[static_cast<std::size_t>(7 * a + b)], expected, 1e-5);
        }
    }
}

TEST(Dictionary, SetAtomScalesToNormOneAndLeavesZeroAlone) {
    Dictionary dictionary = random_dictionary(2, 4);
    Random random(5);
    Floats field = random_field(dictionary.pattern(), random);
    for (float& value : field) value *= 37;
    set_atom(dictionary, 0, field);
    EXPECT_NEAR(norm(dictionary.atom(0)), 1, 1e-5);
    EXPECT_NEAR(dictionary.atom(0)[3] * norm(field), field[3], 1e-3);
    set_atom(dictionary, 1, Floats(dictionary.stride(), 0.0F));
    EXPECT_EQ(norm(dictionary.atom(1)), 0);
}

TEST(DictionaryUpdate, LowersTheMisfitAndKeepsNormsAtMostOne) {
    Dictionary dictionary = random_dictionary(6, 6);
    Random random(7);
    DictionaryStatistics statistics(6, dictionary.stride());
    std::vector<Floats> fields;
    std::vector<Floats> codes;
    for (int i = 0; i < 40; ++i) {
        fields.push_back(random_field(dictionary.pattern(), random));
        codes.push_back(random_floats(6, random));
        statistics.add(codes.back(), fields.back());
    }
    const auto total = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < 40; ++i) sum += misfit(dictionary, fields[i], codes[i]);
        return sum;
    };
    double previous = total();
    for (int sweep = 0; sweep < 5; ++sweep) {
        EXPECT_TRUE(statistics.update(dictionary).empty());
        const double now = total();
        EXPECT_LE(now, previous * (1 + 1e-6)) << "sweep " << sweep;
        if (sweep == 0) {
            EXPECT_LT(now, 0.999 * previous);
        }
        previous = now;
        for (int k = 0; k < 6; ++k) EXPECT_LE(norm(dictionary.atom(k)), 1 + 1e-5);
    }
}

TEST(DictionaryUpdate, NamesAtomsThatNoCodeUsesAndLeavesThem) {
    Dictionary dictionary = random_dictionary(3, 8);
    const Floats before(dictionary.atom(1).begin(), dictionary.atom(1).end());
    Random random(9);
    DictionaryStatistics statistics(3, dictionary.stride());
    statistics.add(Floats{1.0F, 0.0F, -0.5F}, random_field(dictionary.pattern(), random));
    EXPECT_EQ(statistics.update(dictionary), std::vector<int>{1});
    EXPECT_TRUE(std::equal(before.begin(), before.end(), dictionary.atom(1).begin()));
}

TEST(DictionaryUpdate, StatisticsOfPartsAddUp) {
    Dictionary whole = random_dictionary(4, 10);
    Dictionary parts = whole;
    DictionaryStatistics all(4, whole.stride());
    DictionaryStatistics first(4, whole.stride());
    DictionaryStatistics second(4, whole.stride());
    Random random(11);
    for (int i = 0; i < 20; ++i) {
        const Floats field = random_field(whole.pattern(), random);
        const Floats code = random_floats(4, random);
        all.add(code, field);
        (i < 10 ? first : second).add(code, field);
    }
    first.add(second);
    (void)all.update(whole);
    (void)first.update(parts);
    for (int k = 0; k < 4; ++k) {
        for (std::size_t i = 0; i < whole.stride(); ++i) {
            ASSERT_NEAR(whole.atom(k)[i], parts.atom(k)[i], 1e-4);
        }
    }
}

TEST(DictionaryLearning, DrawsAtomsFromTheSample) {
    const FieldSample sample = hidden_sample(50, 1);
    const Dictionary dictionary = draw_dictionary(Pattern::grid(8), 8, sample, 3);
    for (int k = 0; k < 8; ++k) {
        double best = 0;
        for (std::size_t i = 0; i < sample.count(); ++i) {
            double product = 0;
            for (std::size_t j = 0; j < sample.stride; ++j) {
                product += double{sample[i][j]} * dictionary.atom(k)[j];
            }
            best = std::max(best, product / norm(sample[i]));
        }
        EXPECT_NEAR(best, 1, 1e-4) << "atom " << k;
    }
}

TEST(DictionaryLearning, OfAnEmptySampleDoesNothing) {
    Dictionary dictionary = draw_dictionary(Pattern::grid(8), 3, {}, 1);
    SparseCodes codes;
    learn_dictionary({}, {}, 3, 1, dictionary, codes, {});
    for (int k = 0; k < 3; ++k) EXPECT_EQ(norm(dictionary.atom(k)), 0);
}

TEST(DictionaryLearning, LowersTheEnergyRoundByRoundAndFindsTheHiddenAtoms) {
    const FieldSample sample = hidden_sample(300, 2);
    const Coder coder{.lambda = 0.05F};
    Dictionary dictionary = draw_dictionary(Pattern::grid(8), 6, sample, 1);
    SparseCodes codes(sample.count(), 6);
    double previous = 1e300;
    for (int round = 0; round < 6; ++round) {
        learn_dictionary(sample, coder, 1, 1, dictionary, codes, {});
        // The codes were made before the last update of the dictionary, which only lowers it.
        const double now = energy(sample, dictionary, codes, coder.lambda);
        EXPECT_LE(now, previous * (1 + 1e-5)) << "round " << round;
        previous = now;
    }
    double field_norms = 0;
    for (std::size_t i = 0; i < sample.count(); ++i) field_norms += std::pow(norm(sample[i]), 2);
    EXPECT_LT(previous, 0.1 * field_norms);
}

TEST(DictionaryLearning, DoesNotDependOnTheNumberOfThreads) {
    const FieldSample sample = hidden_sample(900, 3);
    const auto learn = [&](int threads) {
        Dictionary dictionary = draw_dictionary(Pattern::grid(8), 5, sample, 1);
        SparseCodes codes(sample.count(), 5);
        learn_dictionary(sample, {.lambda = 0.2F}, 3, 1, dictionary, codes, {.threads = threads});
        return Floats(dictionary.data(), dictionary.data() + 5 * dictionary.stride());
    };
    const Floats one = learn(1);
    EXPECT_EQ(learn(2), one);
    EXPECT_EQ(learn(5), one);
}

TEST(Dictionary, TransposedHasAnAtomInEachColumnAndWholeLines) {
    const Dictionary dictionary = random_dictionary(12, 12);
    const AlignedFloats transposed = dictionary.transposed_panels();  // one panel
    ASSERT_EQ(transposed.size(), 16 * dictionary.stride());
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(transposed.data()) % 64, 0U);
    for (std::size_t i = 0; i < dictionary.stride(); ++i) {
        for (std::size_t k = 0; k < 16; ++k) {
            const float expected = k < 12 ? dictionary.atom(static_cast<int>(k))[i] : 0.0F;
            ASSERT_EQ(transposed[i * 16 + k], expected);
        }
    }
}

TEST(Coder, CorrelatesSeveralFieldsWithAllAtoms) {
    const Dictionary dictionary = random_dictionary(12, 12);
    const CodingMatrices matrices(dictionary);
    Random random(14);
    AlignedFloats fields;
    for (int i = 0; i < 3; ++i) {
        const Floats field = random_field(dictionary.pattern(), random);
        fields.insert(fields.end(), field.begin(), field.end());
    }
    AlignedFloats correlations(3 * matrices.width);
    Coder::correlate(matrices, fields, correlations);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 12; ++k) {
            const auto atom = dictionary.atom(static_cast<int>(k));
            const double expected = std::inner_product(
                atom.begin(), atom.end(),
                fields.begin() + static_cast<std::ptrdiff_t>(i * matrices.stride), 0.0);
            EXPECT_NEAR(correlations[i * matrices.width + k], expected, 1e-4);
        }
    }
}

TEST(Coder, BothMethodsGiveTheSameCode) {
    const Dictionary dictionary = random_dictionary(12, 12);
    const CodingMatrices matrices(dictionary);
    Random random(13);
    for (int trial = 0; trial < 20; ++trial) {
        const Floats field = random_field(dictionary.pattern(), random);
        Floats descended(12, 0.0F);
        Floats exact(12, 0.0F);
        Coder coder{.lambda = 0.5F};
        coder.encode(matrices, field, descended);
        coder.method = LassoMethod::Lars;
        coder.encode(matrices, field, exact);
        for (std::size_t k = 0; k < 12; ++k) ASSERT_NEAR(descended[k], exact[k], 1e-3);
    }
}

TEST(SparseCodes, GiveEachFieldItsOwnCoefficients) {
    SparseCodes codes(3, 4);
    EXPECT_EQ(codes.size(), 3U);
    codes[1][2] = 5;
    EXPECT_EQ(codes[0][2], 0);
    EXPECT_EQ(codes[1][2], 5);
    EXPECT_EQ(codes[2].size(), 4U);
    EXPECT_EQ(SparseCodes().size(), 0U);
}

}  // namespace
}  // namespace lpf

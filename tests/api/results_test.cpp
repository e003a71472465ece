#include "api/results.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "api/analysis_json.h"
#include "api/codec/format.h"
#include "api/dictionary_document.h"
#include "api/fields_document.h"
#include "api/report.h"
#include "tests/api/samples.h"

namespace lpf {
namespace {

using nlohmann::json;

DictionaryDocument sample_document() {
    return make_dictionary_document(test::small_analysis(), test::kDictionaryId, test::kJobId,
                                    test::kTime);
}

ErrorCode refusal(const json& document, const Limits& limits = {}) {
    try {
        (void)dictionary_from_json(document, limits);
    } catch (const Error& error) {
        return error.code();
    }
    ADD_FAILURE() << "accepted";
    return ErrorCode::Internal;
}

/// The value of a scalar column in a row. @pre the attribute is there
double column(const PointCloud& cloud, const std::string& name, std::size_t row) {
    for (const Attribute& attribute : cloud.attributes) {
        if (attribute.name == name) return value_at(attribute, row);
    }
    ADD_FAILURE() << "no column " << name;
    return 0.0;
}

const Attribute& list_column(const PointCloud& cloud, const std::string& name) {
    for (const Attribute& attribute : cloud.attributes) {
        if (attribute.name == name) return attribute;
    }
    throw std::runtime_error("no column " + name);
}

TEST(Results, ListEachFileWithItsAddress) {
    const json list = results_to_json("ID", {{ResultKind::Points, "application/ply", 10, "aa"},
                                             {ResultKind::Report, "application/json", 5, "bb"}});
    EXPECT_EQ(list, (json{{"points",
                           {{"href", "/v1/jobs/ID/results/points"},
                            {"type", "application/ply"},
                            {"bytes", 10},
                            {"sha256", "aa"}}},
                          {"report",
                           {{"href", "/v1/jobs/ID/results/report"},
                            {"type", "application/json"},
                            {"bytes", 5},
                            {"sha256", "bb"}}}}));
}

TEST(DictionaryDocument, HasTheShapeOfTheContract) {
    const json document = to_json(sample_document());
    const auto m = static_cast<std::size_t>(Pattern::grid(8).size());
    EXPECT_EQ(document["id"], test::kDictionaryId);
    EXPECT_EQ(document["sourceJob"], test::kJobId);
    ASSERT_EQ(document["atoms"].size(), 3U);
    ASSERT_EQ(document["atoms"][0].size(), m);
    ASSERT_EQ(document["atoms"][0][0].size(), 3U);
    ASSERT_EQ(document["patternPoints"].size(), m);
    EXPECT_EQ(document["atoms"][2][0], (json{0.03, 0.0, 0.0}));
    EXPECT_EQ(document["atoms"][1][5], (json{0.0, 0.0, 0.005}));
    EXPECT_EQ(document["pattern"], (json{{"kind", "grid"}, {"gridSize", 8}}));
    EXPECT_EQ(document["usage"], (json{0.5, 0.0, 0.5}));
    EXPECT_EQ(document["energy"], (json{1.5, 0.75}));
    EXPECT_EQ(document["energySteps"][0],
              (json{{"learning", 3.0}, {"pose", 2.0}, {"probing", 1.5}}));
}

TEST(DictionaryDocument, ComesBackExactly) {
    const DictionaryDocument before = sample_document();
    const DictionaryDocument after = dictionary_from_json(to_json(before), Limits{});
    EXPECT_EQ(to_json(after), to_json(before));
    EXPECT_EQ(after.dictionary.pattern().grid_size(), 8);
    for (int k = 0; k < 3; ++k) {
        const auto a = before.dictionary.atom(k);
        const auto b = after.dictionary.atom(k);
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << k;
    }
}

TEST(DictionaryDocument, OwnPatternComesBackAsPoints) {
    const Pattern disk = Pattern::random_disk(20, 7);
    DictionaryDocument before = sample_document();
    before.dictionary = Dictionary(disk, 2);
    before.dictionary.atom(1)[3] = 0.3F;
    before.usage = {1.0F, 0.0F};
    const DictionaryDocument after = dictionary_from_json(to_json(before), Limits{});
    ASSERT_EQ(after.dictionary.pattern().size(), 20);
    EXPECT_EQ(after.dictionary.pattern().grid_size(), 0);
    EXPECT_EQ(after.dictionary.pattern().point(7), disk.point(7));
    EXPECT_EQ(after.dictionary.atom(1)[3], 0.3F);
}

TEST(DictionaryDocument, SummaryHasCountsInsteadOfArrays) {
    const json summary = summary_to_json(sample_document());
    EXPECT_EQ(summary["atoms"], 3);
    EXPECT_EQ(summary["patternPoints"], Pattern::grid(8).size());
    EXPECT_EQ(summary["links"][1]["href"], "/v1/dictionaries/" + test::kDictionaryId + "/data");
    EXPECT_EQ(dictionary_list_to_json({summary})["dictionaries"][0], summary);
}

TEST(DictionaryDocument, MissingOrWrongMembersAreMalformed) {
    const json good = to_json(sample_document());
    for (const char* name : {"atoms", "patternPoints"}) {
        json bad = good;
        bad.erase(name);
        EXPECT_EQ(refusal(bad), ErrorCode::MalformedFile) << name;
        bad[name] = json::array();
        EXPECT_EQ(refusal(bad), ErrorCode::MalformedFile) << name;
        bad[name] = 3;
        EXPECT_EQ(refusal(bad), ErrorCode::MalformedFile) << name;
    }
    const std::pair<const char*, json> wrong[] = {
        {"radius", "x"}, {"usage", {"a", "b", "c"}},     {"energySteps", {1}}, {"created", 3},
        {"id", 3},       {"pattern", {{"kind", "grid"}}}};
    for (const auto& [name, value] : wrong) {
        json bad = good;
        bad[name] = value;
        EXPECT_EQ(refusal(bad), ErrorCode::MalformedFile) << name;
    }
    EXPECT_EQ(refusal(json::array()), ErrorCode::MalformedFile);
}

TEST(DictionaryDocument, RowsMustBeFiniteTriples) {
    json bad = to_json(sample_document());
    bad["atoms"][1][4] = {0.0, 0.0};
    EXPECT_EQ(refusal(bad), ErrorCode::MalformedFile);
    bad["atoms"][1][4] = {0.0, nullptr, 0.0};
    EXPECT_EQ(refusal(bad), ErrorCode::MalformedFile);
    bad["atoms"][1][4] = {0.0, std::numeric_limits<double>::infinity(), 0.0};
    EXPECT_EQ(refusal(bad), ErrorCode::MalformedFile);
}

TEST(DictionaryDocument, AtomsMustHaveNormOneAtMost) {
    json document = to_json(sample_document());
    document["atoms"][0][0] = {1.01, 0.0, 0.0};
    EXPECT_EQ(refusal(document), ErrorCode::MalformedFile);
    document["atoms"][0][0] = {1e38, 1e38, 0.0};
    EXPECT_EQ(refusal(document), ErrorCode::MalformedFile);
}

TEST(DictionaryDocument, SizesMustFitEachOther) {
    json bad = to_json(sample_document());
    bad["atoms"][2].erase(0);
    EXPECT_EQ(refusal(bad), ErrorCode::IncompatibleDictionary);
    bad = to_json(sample_document());
    bad["pattern"]["gridSize"] = 10;
    EXPECT_EQ(refusal(bad), ErrorCode::IncompatibleDictionary);
    bad = to_json(sample_document());
    bad["usage"] = {0.5};
    EXPECT_EQ(refusal(bad), ErrorCode::IncompatibleDictionary);
}

TEST(DictionaryDocument, LimitsHold) {
    const json document = to_json(sample_document());
    EXPECT_EQ(refusal(document, Limits{.atoms = 2}), ErrorCode::LimitExceeded);
    EXPECT_EQ(refusal(document, Limits{.pattern_points = 10}), ErrorCode::LimitExceeded);
}

TEST(Npy, HasTheHeaderAndTheAtomsInOrder) {
    const Dictionary dictionary = test::small_dictionary(2);
    const auto m = static_cast<std::size_t>(dictionary.pattern().size());
    const std::string file = atoms_to_npy(dictionary);
    EXPECT_EQ(file.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    const auto length = static_cast<std::size_t>(static_cast<unsigned char>(file[8])) +
                        256 * static_cast<std::size_t>(static_cast<unsigned char>(file[9]));
    const std::size_t begin = 10 + length;
    EXPECT_EQ(begin % 64, 0U);
    EXPECT_EQ(file[begin - 1], '\n');
    EXPECT_NE(file.find("'shape': (2, " + std::to_string(m) + ", 3)"), std::string::npos);
    ASSERT_EQ(file.size(), begin + 2 * m * 3 * 4);
    const auto value = [&](std::size_t k, std::size_t i, std::size_t c) {
        float result = 0.0F;
        std::memcpy(&result, file.data() + begin + 4 * ((k * m + i) * 3 + c), sizeof result);
        return result;
    };
    EXPECT_EQ(value(1, 0, 0), 0.02F);
    EXPECT_EQ(value(0, 7, 2), 0.007F);
    EXPECT_EQ(value(0, 7, 1), 0.0F);
}

TEST(Shortest, ReadsBackAsTheSameFloat) {
    EXPECT_EQ(shortest(0.1F), 0.1);
    for (const float value : {0.0F, -1.5F, 3.4e38F, 1e-42F, 0.33333334F}) {
        EXPECT_EQ(static_cast<float>(shortest(value)), value);
    }
}

TEST(FieldsDocument, HasOneVertexPerField) {
    const PointCloud cloud = fields_document(test::small_analysis()).shape.cloud;
    ASSERT_EQ(cloud.size(), 2U);
    EXPECT_EQ(cloud.points.col(0), Eigen::Vector3d(500000.5, 2.0, 3.0));
    EXPECT_EQ(column(cloud, "t1x", 0), 1.0);
    EXPECT_EQ(column(cloud, "t2y", 0), 1.0);
    EXPECT_EQ(column(cloud, "nz", 0), 1.0);
    EXPECT_EQ(column(cloud, "nx", 0), 0.0);
    EXPECT_EQ(column(cloud, "radius", 1), 0.5);
    EXPECT_EQ(column(cloud, "residual", 1), 0.25);
    EXPECT_EQ(column(cloud, "dimension", 0), 2.0);
}

TEST(FieldsDocument, CodesAreListsOfTheAtomsInUse) {
    const PointCloud cloud = fields_document(test::small_analysis()).shape.cloud;
    const Attribute& indices = list_column(cloud, "atom_indices");
    const Attribute& coefficients = list_column(cloud, "coefficients");
    EXPECT_EQ(indices.list_offsets, (std::vector<std::uint64_t>{0, 2, 2}));
    EXPECT_EQ(coefficients.list_offsets, indices.list_offsets);
    EXPECT_EQ(indices.type, ScalarType::UInt16);
    EXPECT_EQ(indices.count_type, ScalarType::UInt8);
    std::uint16_t atoms[2];
    float values[2];
    ASSERT_EQ(indices.data.size(), sizeof atoms);
    ASSERT_EQ(coefficients.data.size(), sizeof values);
    std::memcpy(atoms, indices.data.data(), sizeof atoms);
    std::memcpy(values, coefficients.data.data(), sizeof values);
    EXPECT_EQ(atoms[1], 2);
    EXPECT_EQ(values[1], -2.0F);
}

TEST(FieldsDocument, IsWrittenAndReadAsPly) {
    std::vector<Warning> lost;
    const std::string file =
        encode(fields_document(test::small_analysis()), {.double_positions = true}, lost);
    EXPECT_TRUE(lost.empty());
    EXPECT_NE(file.find("property list uchar ushort atom_indices"), std::string::npos);
    EXPECT_NE(file.find("property list uchar float coefficients"), std::string::npos);
    const Document back = decode(std::as_bytes(std::span(file)));
    ASSERT_EQ(back.shape.size(), 2U);
    EXPECT_EQ(back.shape.cloud.points(0, 0), 500000.5);
}

TEST(Displacement, StatisticsOfKnownMoves) {
    Points before = Points::Zero(3, 4);
    Points after = Points::Zero(3, 4);
    for (int i = 0; i < 4; ++i) after(i % 3, i) = i;  // lengths 0, 1, 2, 3
    const DisplacementStatistics s = displacement_statistics(before, after);
    EXPECT_DOUBLE_EQ(s.rms, std::sqrt(14.0 / 4.0));
    EXPECT_DOUBLE_EQ(s.mean, 1.5);
    EXPECT_EQ(s.p50, 1.0);
    EXPECT_EQ(s.p90, 3.0);
    EXPECT_EQ(s.p99, 3.0);
    EXPECT_EQ(s.max, 3.0);
    EXPECT_EQ(displacement_statistics(Points(3, 0), Points(3, 0)).max, 0.0);
    const DisplacementStatistics of_lengths = displacement_statistics({4.0F, 0.0F, 2.0F, 2.0F});
    EXPECT_EQ(of_lengths.mean, 2.0);
    EXPECT_EQ(of_lengths.rms, std::sqrt(6.0));
    EXPECT_EQ(of_lengths.p50, 2.0);
    EXPECT_EQ(of_lengths.max, 4.0);
}

TEST(Report, SaysWhatTheProcessHas) {
    EXPECT_TRUE(to_json(test::full_report(Task::Denoise)).contains("rmsMoves"));
    EXPECT_FALSE(to_json(test::full_report(Task::Resample)).contains("rmsMoves"));
    const json analysis = to_json(test::full_report(Task::Analyze));
    EXPECT_FALSE(analysis.contains("output"));
    EXPECT_EQ(analysis["phases"][1], (json{{"phase", "learn"}, {"seconds", 1.5}}));
    EXPECT_EQ(analysis["input"]["faces"], 4);
}

}  // namespace
}  // namespace lpf

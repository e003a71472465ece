// A taste of the experiments at reduced size; scripts/paper.sh runs them whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "tests/paper/document.h"
#include "tests/paper/experiments.h"

namespace lpf::paper {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(PaperNumber, KeepsSignificantDigits) {
    EXPECT_EQ(number(0.012345).text, "0.0123");
    EXPECT_EQ(number(123.456).text, "123");
    EXPECT_EQ(number(360000, 1).text, "360000");
    EXPECT_EQ(number(0.0).text, "0");
    EXPECT_EQ(number(-2e-15).text, "0");
    EXPECT_EQ(percent(0.015, 2).text, "1.5 %");
    EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()).text, "-");
    EXPECT_FALSE(number(std::numeric_limits<double>::quiet_NaN()).value.has_value());
}

TEST(PaperTable, NumbersAreFoundByName) {
    const Table table{{"points", "RMSE"}, {{"input", number(0.5)}, {"result", "-"}}};
    EXPECT_EQ(table.at("input", "RMSE"), 0.5);
    EXPECT_THROW((void)table.at("result", "RMSE"), std::out_of_range);
    EXPECT_THROW((void)table.at("input", "none"), std::out_of_range);
}

TEST(PaperDocument, SaysWhatHoldsAndWhatDoesNot) {
    const Section section{.title = "Fig. 99: a test",
                          .tables = {{{"a", "b"}, {{"row", number(0.25)}}}},
                          .claims = {{"yes", true}, {"no", false}}};
    const std::string text = document({{section, 3.0}}, {"a machine", "abc", 2, {"ship"}});
    EXPECT_THAT(text, HasSubstr("| row | 0.250 |"));
    EXPECT_THAT(text, HasSubstr("- holds: yes"));
    EXPECT_THAT(text, HasSubstr("- **does not hold**: no"));
    EXPECT_THAT(text, HasSubstr("Of 2 statements 1 hold"));
    EXPECT_THAT(text, HasSubstr("commit abc"));
    EXPECT_THAT(text, HasSubstr("Not run this time: `ship`."));
}

void expect_all_hold(const Section& section) {
    ASSERT_FALSE(section.claims.empty());
    for (const Claim& claim : section.claims) EXPECT_TRUE(claim.holds) << claim.text;
    EXPECT_TRUE(section.pictures.empty()) << "no folder, no pictures";
    EXPECT_THAT(markdown(section, 1.0), HasSubstr("## " + section.title));
}

TEST(PaperExperiment, PlaneIsSpacedByThePattern) { expect_all_hold(plane({})); }

TEST(PaperExperiment, CubeKeepsItsEdges) { expect_all_hold(cube_denoising({.size = 0.5})); }

TEST(PaperExperiment, EnergyIsStableOverInitialDictionaries) {
    const Section section = stability({.size = 0.06});
    EXPECT_TRUE(section.claims.at(0).holds) << section.claims.at(0).text;
    EXPECT_EQ(section.tables.at(0).at("here", "runs"), 3);
    EXPECT_GT(section.tables.at(0).at("here", "standard deviation"), 0.0)
        << "the same run each time";
}

}  // namespace
}  // namespace lpf::paper

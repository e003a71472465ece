#include "core/shape/coloured_cells.h"

#include <gtest/gtest.h>

#include "tests/core/clouds.h"

namespace lpf {
namespace {

class ColouredCellsOf : public testing::TestWithParam<test::NamedCloud> {
protected:
    /// @returns the cell of each place, by its colour and key
    std::vector<std::pair<std::size_t, std::uint32_t>> cells_of_places(double side) {
        const ColouredCells cells(grid, places, side, {.threads = 2});
        std::vector<std::pair<std::size_t, std::uint32_t>> result(places.size());
        std::vector<int> met(places.size(), 0);
        for (std::size_t colour = 0; colour < ColouredCells::kColours; ++colour) {
            for (const auto& [key, begin, end] : cells.of_colour(colour)) {
                for (std::uint32_t i = begin; i < end; ++i) {
                    result[cells.member(i)] = {colour, key};
                    ++met[cells.member(i)];
                }
            }
        }
        for (const int times : met) EXPECT_EQ(times, 1);
        return result;
    }

    PointGrid grid{GetParam().points, 0.3};
    std::vector<std::uint32_t> places = grid.places();
};

TEST_P(ColouredCellsOf, CellsOfOneColourAreASideApart) {
    if (places.empty()) return;
    constexpr double kSide = 0.4;
    const auto cells = cells_of_places(kSide);
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (cells[i].first != cells[j].first || cells[i].second == cells[j].second) continue;
            const Eigen::Vector3d between = grid.point(places[i]) - grid.point(places[j]);
            ASSERT_GE(between.cwiseAbs().maxCoeff(), kSide * (1 - 1e-9));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, ColouredCellsOf, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(ColouredCells, MembersOfACellAscend) {
    const PointGrid grid(test::random_box(2000, 3), 0.2);
    const std::vector<std::uint32_t> places = grid.places();
    const ColouredCells cells(grid, places, 0.3, {});
    std::size_t count = 0;
    for (std::size_t colour = 0; colour < ColouredCells::kColours; ++colour) {
        for (const auto& cell : cells.of_colour(colour)) {
            ++count;
            for (std::uint32_t i = cell.begin + 1; i < cell.end; ++i) {
                ASSERT_LT(cells.member(i - 1), cells.member(i));
            }
        }
    }
    EXPECT_GT(count, 8U) << "several cells of each colour are what threads share";
}

}  // namespace
}  // namespace lpf

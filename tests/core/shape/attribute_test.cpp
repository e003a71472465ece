#include "core/shape/attribute.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <vector>

namespace lpf {
namespace {

template <typename T>
Attribute column(ScalarType type, const std::vector<T>& values) {
    Attribute attribute;
    attribute.name = "a";
    attribute.type = type;
    const auto bytes = std::as_bytes(std::span(values));
    attribute.data.assign(bytes.begin(), bytes.end());
    return attribute;
}

std::vector<double> values_of(const Attribute& attribute) {
    std::vector<double> values;
    for (std::size_t i = 0; i < attribute.rows(); ++i) values.push_back(value_at(attribute, i));
    return values;
}

template <typename T>
void expect_limits_survive(ScalarType type) {
    using Limits = std::numeric_limits<T>;
    const std::vector<T> values = {Limits::lowest(), T{1}, Limits::max()};
    const Attribute attribute = column(type, values);
    EXPECT_EQ(size_of(type), sizeof(T));
    ASSERT_EQ(attribute.rows(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(value_at(attribute, i), static_cast<double>(values[i]));
    }
}

TEST(Attribute, ReadsEveryTypeToItsLimits) {
    expect_limits_survive<std::int8_t>(ScalarType::Int8);
    expect_limits_survive<std::uint8_t>(ScalarType::UInt8);
    expect_limits_survive<std::int16_t>(ScalarType::Int16);
    expect_limits_survive<std::uint16_t>(ScalarType::UInt16);
    expect_limits_survive<std::int32_t>(ScalarType::Int32);
    expect_limits_survive<std::uint32_t>(ScalarType::UInt32);
    expect_limits_survive<float>(ScalarType::Float32);
    expect_limits_survive<double>(ScalarType::Float64);
}

TEST(Attribute, FloatColumnKeepsNameAndValues) {
    const std::vector<float> values = {1.5F, -2.0F};
    const Attribute attribute = float_attribute("intensity", values);
    EXPECT_EQ(attribute.name, "intensity");
    EXPECT_EQ(attribute.type, ScalarType::Float32);
    EXPECT_THAT(values_of(attribute), testing::ElementsAre(1.5, -2.0));
}

TEST(Attribute, FloatColumnMayBeEmpty) { EXPECT_EQ(float_attribute("empty", {}).rows(), 0U); }

TEST(AttributeGather, TakesRowsInTheOrderAskedForAndMoreThanOnce) {
    const Attribute source = column<std::int16_t>(ScalarType::Int16, {10, 11, 12, 13});
    const std::vector<std::uint32_t> rows = {3, 0, 0, 2};
    const Attribute result = gather(source, rows);
    EXPECT_EQ(result.name, "a");
    EXPECT_EQ(result.type, ScalarType::Int16);
    EXPECT_THAT(values_of(result), testing::ElementsAre(13, 10, 10, 12));
}

TEST(AttributeGather, OfNoRowsIsEmpty) {
    const Attribute source = column<std::uint8_t>(ScalarType::UInt8, {1, 2});
    EXPECT_EQ(gather(source, {}).rows(), 0U);
}

TEST(AttributeGather, KeepsListsOfDifferentLengths) {
    Attribute source = column<std::int32_t>(ScalarType::Int32, {1, 2, 3, 4, 5, 6});
    source.list_offsets = {0, 2, 2, 5, 6};  // {1 2} {} {3 4 5} {6}
    source.count_type = ScalarType::UInt16;
    const std::vector<std::uint32_t> rows = {2, 1, 0, 2};
    const Attribute result = gather(source, rows);
    EXPECT_TRUE(result.is_list());
    EXPECT_EQ(result.rows(), 4U);
    EXPECT_EQ(result.count_type, ScalarType::UInt16);
    EXPECT_THAT(result.list_offsets, testing::ElementsAre(0, 3, 3, 5, 8));
    Attribute flat = result;
    flat.list_offsets.clear();
    EXPECT_THAT(values_of(flat), testing::ElementsAre(3, 4, 5, 1, 2, 3, 4, 5));
}

TEST(AttributeGather, OfNoListsIsAnEmptyListColumn) {
    Attribute source = column<float>(ScalarType::Float32, {1.0F});
    source.list_offsets = {0, 1};
    const Attribute result = gather(source, {});
    EXPECT_TRUE(result.is_list());
    EXPECT_EQ(result.rows(), 0U);
}

}  // namespace
}  // namespace lpf

#include "api/attribute_plan.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

namespace lpf {
namespace {

Document coloured_mesh() {
    Document document;
    PointCloud& cloud = document.shape.cloud;
    cloud.points = Points::Random(3, 40);
    const std::vector<float> values(40, 0.5F);
    cloud.attributes = {float_attribute("red", values), float_attribute("nx", values)};
    document.shape.triangles.resize(3, 2);
    document.shape.triangles << 0, 30, 1, 31, 2, 39;
    Attribute quality = float_attribute("quality", std::vector<float>(2, 1.0F));
    document.face_attributes = {quality};
    document.elements = {{"camera", 1, {float_attribute("focal", std::vector<float>(1, 2.0F))}}};
    return document;
}

std::map<std::string, AttributePlan> plan(Task task, const JobInputs& inputs = {}) {
    std::map<std::string, AttributePlan> by_name;
    for (const AttributePlan& entry : plan_attributes(task, coloured_mesh(), inputs, 14)) {
        EXPECT_FALSE(entry.detail.empty()) << entry.name;
        by_name[entry.name] = entry;
    }
    return by_name;
}

TEST(AttributePlan, DenoisingKeepsEverything) {
    auto entries = plan(Task::Denoise);
    EXPECT_EQ(entries["position"].fate, Fate::Computed);
    for (const char* name : {"red", "nx", "vertex_indices", "quality", "camera"})
        EXPECT_EQ(entries[name].fate, Fate::Kept) << name;
    EXPECT_EQ(entries["quality"].element, "face");
}

TEST(AttributePlan, ResamplingCarriesAttributesAndDropsFaces) {
    auto entries = plan(Task::Resample);
    EXPECT_EQ(entries["red"].fate, Fate::Carried);
    EXPECT_EQ(entries["vertex_indices"].fate, Fate::Dropped);
    EXPECT_EQ(entries["quality"].fate, Fate::Dropped);
    EXPECT_EQ(entries["camera"].fate, Fate::Kept);
}

TEST(AttributePlan, AnAnalysisUsesNoAttribute) {
    for (const auto& [name, entry] : plan(Task::Analyze)) EXPECT_EQ(entry.fate, Fate::Unused);
}

TEST(AttributePlan, DoesAsItWasAsked) {
    auto entries = plan(Task::Denoise, {.attributes = AttributePolicy::Drop});
    EXPECT_EQ(entries["red"].fate, Fate::Dropped);
    EXPECT_NE(entries["red"].detail.find("attributes=drop"), std::string::npos);
    entries =
        plan(Task::Denoise, {.outliers = OutlierPolicy::Mark, .normals = NormalPolicy::Estimate});
    EXPECT_EQ(entries["nx"].fate, Fate::Computed);
    EXPECT_EQ(entries["nz"].fate, Fate::Computed);
    EXPECT_EQ(entries["outlier"].fate, Fate::Computed);
    EXPECT_EQ(plan(Task::Denoise, {.normals = NormalPolicy::Drop})["nx"].fate, Fate::Dropped);
}

TEST(AttributePlan, DracoQuantisesAndDropsWhatItCannotHold) {
    auto entries = plan(Task::Denoise, {.format = FileFormat::Draco});
    EXPECT_NE(entries["position"].detail.find("14 bits"), std::string::npos);
    EXPECT_EQ(entries["red"].fate, Fate::Kept);
    EXPECT_EQ(entries["camera"].fate, Fate::Dropped);
}

TEST(AttributePlan, IsThatOfTheWholeFileHoweverSmall) {
    Document tiny;
    tiny.shape.cloud.points = Points::Random(3, 3);
    EXPECT_EQ(plan_attributes(Task::Denoise, tiny, {}, 0).size(), 1U);
}

TEST(AttributePlan, FormatIsThatOfTheInputUnlessAnotherIsAskedFor) {
    EXPECT_EQ(result_format({}, FileFormat::Draco), FileFormat::Draco);
    EXPECT_EQ(result_format({}, FileFormat::PlyBigEndian), FileFormat::PlyBinary);
    EXPECT_EQ(result_format({.format = FileFormat::PlyAscii}, FileFormat::Draco),
              FileFormat::PlyAscii);
}

}  // namespace
}  // namespace lpf

#include "api/job.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/api/samples.h"

namespace lpf {
namespace {

using nlohmann::json;

constexpr JobStatus kAll[] = {JobStatus::Accepted, JobStatus::Running, JobStatus::Successful,
                              JobStatus::Failed, JobStatus::Dismissed};

TEST(JobStatus, NamesAreThoseOfOgc) {
    EXPECT_EQ(status_name(JobStatus::Accepted), "accepted");
    EXPECT_EQ(status_name(JobStatus::Dismissed), "dismissed");
    for (const JobStatus status : kAll) EXPECT_EQ(status_from_name(status_name(status)), status);
    EXPECT_FALSE(status_from_name("done"));
}

TEST(JobStatus, NothingFollowsAnEnd) {
    for (const JobStatus from : kAll) {
        for (const JobStatus to : kAll) {
            if (is_finished(from) || from == to) {
                EXPECT_FALSE(may_become(from, to));
            }
        }
    }
    EXPECT_TRUE(may_become(JobStatus::Accepted, JobStatus::Running));
    EXPECT_TRUE(may_become(JobStatus::Accepted, JobStatus::Dismissed));
    EXPECT_FALSE(may_become(JobStatus::Accepted, JobStatus::Successful));
    EXPECT_TRUE(may_become(JobStatus::Running, JobStatus::Accepted));
    EXPECT_TRUE(may_become(JobStatus::Running, JobStatus::Successful));
}

TEST(StatusInfo, ComesBackFromJson) {
    const json document = to_json(test::full_status());
    EXPECT_EQ(to_json(status_from_json(document)), document);
}

TEST(StatusInfo, BareOneComesBackToo) {
    StatusInfo info;
    info.job_id = test::kJobId;
    const json document = to_json(info);
    EXPECT_EQ(to_json(status_from_json(document)), document);
    for (const char* absent : {"started", "finished", "expires", "phase", "phaseProgress",
                               "etaSeconds", "queuePosition", "exception"}) {
        EXPECT_FALSE(document.contains(absent)) << absent;
    }
}

TEST(StatusInfo, HasTheMembersOfTheContract) {
    const json document = to_json(test::full_status());
    for (const char* name : {"jobID",
                             "id",
                             "processID",
                             "type",
                             "status",
                             "message",
                             "progress",
                             "created",
                             "started",
                             "finished",
                             "updated",
                             "expires",
                             "phase",
                             "phaseProgress",
                             "etaSeconds",
                             "queuePosition",
                             "attempt",
                             "parameters",
                             "resolvedParameters",
                             "shape",
                             "warnings",
                             "exception",
                             "links"}) {
        EXPECT_TRUE(document.contains(name)) << name;
    }
    EXPECT_EQ(document["jobID"], document["id"]);
    EXPECT_EQ(document["type"], "process");
    EXPECT_EQ(document["created"], "2026-03-01T12:00:00.123Z");
    EXPECT_EQ(document["parameters"]["factor"], 4.0);
    EXPECT_EQ(document["resolvedParameters"]["radius"],
              (json{{"value", 0.25}, {"source", "auto"}, {"rule", "rule"}}));
    EXPECT_EQ(document["exception"]["code"], "timed-out");
}

TEST(StatusInfo, ProgressIsAnIntegerFromZeroToAHundred) {
    StatusInfo info;
    for (const auto& [progress, shown] : {std::pair{99.9, 99}, {-1.0, 0}, {100.5, 100}}) {
        info.progress = progress;
        EXPECT_EQ(to_json(info)["progress"], shown);
    }
}

TEST(StatusInfo, LinksToResultsOnceThereAreSome) {
    StatusInfo info = test::full_status();
    EXPECT_EQ(to_json(info)["links"].size(), 3U);
    info.status = JobStatus::Successful;
    EXPECT_EQ(to_json(info)["links"][3]["href"], "/v1/jobs/" + test::kJobId + "/results");
}

TEST(StatusInfo, DamageIsToldAsStorageFailure) {
    const json good = to_json(test::full_status());
    for (const char* name : {"jobID", "status", "processID", "created", "updated", "progress"}) {
        for (const json& damage : {json(), json("x")}) {
            json bad = good;
            if (damage.is_null())
                bad.erase(name);
            else if (std::string(name) == "jobID")
                bad[name] = 3;
            else
                bad[name] = damage;
            try {
                (void)status_from_json(bad);
                ADD_FAILURE() << name;
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), ErrorCode::StorageFailure) << name;
            }
        }
    }
}

TEST(ResolvedParameters, NamesBecomeThoseOfTheWire) {
    const auto resolved = resolved_parameters(
        {{"pattern_points", 193.0, true, "a grid"}, {"probing", 1.0, true, "noise"}});
    EXPECT_EQ(resolved[0], (ResolvedParameter{"patternPoints", 193.0, true, "a grid"}));
    EXPECT_EQ(resolved[1],
              (ResolvedParameter{"probing", std::string("noiseAware"), true, "noise"}));
}

TEST(JobList, LinksToTheNextPage) {
    const json list = job_list_to_json({test::full_status()}, "limit=1", "abc");
    EXPECT_EQ(list["jobs"].size(), 1U);
    EXPECT_EQ(list["links"][0]["href"], "/v1/jobs?limit=1");
    EXPECT_EQ(list["links"][1]["rel"], "next");
    EXPECT_EQ(list["links"][1]["href"], "/v1/jobs?limit=1&cursor=abc");
    EXPECT_EQ(job_list_to_json({}, "", "abc")["links"][1]["href"], "/v1/jobs?cursor=abc");
    EXPECT_EQ(job_list_to_json({}, "", "")["links"].size(), 1U);
}

TEST(ShapeInfo, ComesBackFromJson) {
    const json document = to_json(test::full_shape());
    EXPECT_EQ(to_json(shape_from_json(document)), document);
    ShapeInfo bare;
    bare.id = test::kShapeId;
    EXPECT_EQ(to_json(shape_from_json(to_json(bare))), to_json(bare));
}

TEST(ShapeInfo, DamageIsToldAsStorageFailure) {
    json bad = to_json(test::full_shape());
    bad["bounds"]["min"] = {1, 2};
    EXPECT_THROW((void)shape_from_json(bad), Error);
}

TEST(ShapeInfo, DescribesAttributesAndBounds) {
    PointCloud cloud;
    cloud.points.resize(3, 2);
    cloud.points << 1, -1, 5, 2, 0, 9;
    cloud.attributes = {float_attribute("intensity", std::vector<float>{1.0F, 2.0F})};
    EXPECT_EQ(attribute_infos(cloud),
              (std::vector<AttributeInfo>{{"intensity", "float32", false}}));
    EXPECT_EQ(to_json(bounds_of(cloud.points)),
              (json{{"min", {-1.0, 2.0, 0.0}}, {"max", {1.0, 5.0, 9.0}}}));
}

}  // namespace
}  // namespace lpf

#include "api/job_event.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "api/openapi.h"
#include "tests/api/samples.h"
#include "tests/api/schema_checker.h"

namespace lpf {
namespace {

using nlohmann::json;

TEST(JobEvent, IsWrittenAsAnEventStreamWantsIt) {
    EXPECT_EQ(event_text(17, "status", R"({"a":1})"), "id: 17\nevent: status\ndata: {\"a\":1}\n\n");
}

TEST(JobEvent, ProgressHoldsWhatMovesAndNothingElse) {
    const json progress = progress_event_to_json(test::full_status());
    EXPECT_EQ(progress["progress"], 41);
    EXPECT_EQ(progress["phaseProgress"]["done"], 3);
    EXPECT_EQ(progress["queuePosition"], 7);
    EXPECT_FALSE(progress.contains("parameters"));
    StatusInfo bare;
    bare.job_id = test::kJobId;
    EXPECT_FALSE(progress_event_to_json(bare).contains("phase"));
}

TEST(JobEvent, FollowsItsSchema) {
    const json document = openapi_document(Limits{}, "1", "/");
    const std::pair<const char*, json> events[] = {
        {"status", to_json(test::full_status())},
        {"progress", progress_event_to_json(test::full_status())},
        {"log", log_event_to_json(test::kJobId, test::kTime, "phase", "decode")},
        {"end", to_json(test::full_status())}};
    for (const auto& [name, data] : events) {
        const json event = {{"id", 3}, {"event", name}, {"data", data}};
        EXPECT_TRUE(test::component_faults(event, "JobEvent", document).empty()) << name;
        const json wrong = {{"id", 3}, {"event", "other"}, {"data", data}};
        EXPECT_FALSE(test::component_faults(wrong, "JobEvent", document).empty()) << name;
    }
}

}  // namespace
}  // namespace lpf

#include "server/jobs/job_events.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "server/clock.h"

namespace lpf::server {
namespace {

using nlohmann::json;

StatusInfo job(JobStatus status, const std::string& id = "job-1") {
    StatusInfo info;
    info.job_id = id;
    info.status = status;
    info.created = info.updated = now_millis();
    return info;
}

std::vector<std::string> names(const std::vector<JobEvent>& events) {
    std::vector<std::string> result;
    for (const JobEvent& event : events) result.push_back(event.name);
    return result;
}

using Names = std::vector<std::string>;

TEST(JobEvents, AreToldInOrderAndEndWithTheJob) {
    JobEvents events;
    events.status(job(JobStatus::Accepted));
    events.status(job(JobStatus::Running));
    events.log("job-1", "phase", "decode");
    events.progress(job(JobStatus::Running));
    events.status(job(JobStatus::Successful));
    const auto story = events.after("job-1", 0);
    EXPECT_EQ(names(story), (Names{"status", "status", "log", "progress", "status", "end"}));
    for (std::size_t i = 1; i < story.size(); ++i) EXPECT_GT(story[i].id, story[i - 1].id);
    EXPECT_EQ(json::parse(story.back().data)["status"], "successful");
    EXPECT_EQ(json::parse(story[2].data)["detail"], "decode");
    EXPECT_EQ(story[3].data.find('\n'), std::string::npos);
}

TEST(JobEvents, AreReplayedAfterTheLastOneSeen) {
    JobEvents events;
    events.status(job(JobStatus::Accepted));
    const auto seen = events.after("job-1", 0).back().id;
    EXPECT_TRUE(events.after("job-1", seen).empty());
    events.status(job(JobStatus::Running));
    EXPECT_EQ(names(events.after("job-1", seen)), Names{"status"});
    EXPECT_EQ(events.after("job-1", 0).size(), 2U);
}

TEST(JobEvents, KeepOnlyTheLastProgress) {
    JobEvents events;
    events.status(job(JobStatus::Running));
    for (int i = 1; i <= 500; ++i) {
        StatusInfo info = job(JobStatus::Running);
        info.progress = i % 100;
        events.progress(info);
    }
    const auto story = events.after("job-1", 0);
    EXPECT_EQ(names(story), (Names{"status", "progress"}));
    EXPECT_EQ(json::parse(story.back().data)["progress"], 0);
}

TEST(JobEvents, OfAJobAreBounded) {
    JobEvents events;
    for (int i = 0; i < 10'000; ++i) events.log("job-1", "code", std::to_string(i));
    const auto story = events.after("job-1", 0);
    EXPECT_LE(story.size(), 64U);
    EXPECT_EQ(json::parse(story.back().data)["detail"], "9999");
}

TEST(JobEvents, OfManyJobsAreBoundedAndThoseAtWorkStay) {
    JobEvents events;
    events.status(job(JobStatus::Running, "at-work"));
    for (int i = 0; i < 6000; ++i) {
        events.status(job(JobStatus::Successful, "done-" + std::to_string(10'000 + i)));
    }
    EXPECT_TRUE(events.knows("at-work"));
    EXPECT_FALSE(events.knows("done-10000"));
    EXPECT_TRUE(events.knows("done-15999"));
}

TEST(JobEvents, SayNothingAfterTheEnd) {
    JobEvents events;
    events.status(job(JobStatus::Dismissed));
    events.progress(job(JobStatus::Running));
    events.log("job-1", "late", "x");
    EXPECT_EQ(names(events.after("job-1", 0)), (Names{"status", "end"}));
}

TEST(JobEvents, NumbersGrowOverARestart) {
    JobEvents before;
    before.status(job(JobStatus::Running));
    const auto last = before.after("job-1", 0).back().id;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    JobEvents after;
    after.status(job(JobStatus::Running));
    EXPECT_EQ(after.after("job-1", last).size(), 1U);
    EXPECT_LT(last, 1ULL << 53U);  // a number that JavaScript can hold
}

TEST(JobEvents, ANumberOfTheFutureHidesNothing) {
    JobEvents events;
    events.status(job(JobStatus::Running));
    EXPECT_EQ(events.after("job-1", UINT64_MAX).size(), 1U);
}

TEST(JobEvents, TellAJobThatTheyDoNotKnowWithoutKeepingIt) {
    JobEvents events;
    const auto told = events.tell(job(JobStatus::Failed, "old"));
    EXPECT_EQ(names(told), (Names{"status", "end"}));
    EXPECT_GT(told[1].id, told[0].id);
    EXPECT_FALSE(events.knows("old"));
    EXPECT_EQ(names(events.tell(job(JobStatus::Accepted, "old"))), Names{"status"});
}

TEST(JobEvents, OfAJobThatEndedJustNowAreNotForgotten) {
    JobEvents events;
    events.status(job(JobStatus::Successful));
    events.forget_old();
    EXPECT_TRUE(events.knows("job-1"));
    EXPECT_TRUE(events.after("nobody", 0).empty());
}

TEST(JobEvents, ManyThreadsMayTellAndListen) {
    JobEvents events;
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&, id = "job-" + std::to_string(t % 2)] {
            std::uint64_t last = 0;
            for (int i = 0; i < 500; ++i) {
                events.log(id, "code", "x");
                for (const JobEvent& event : events.after(id, last)) {
                    EXPECT_GT(event.id, last);
                    last = event.id;
                }
            }
        });
    }
}

}  // namespace
}  // namespace lpf::server

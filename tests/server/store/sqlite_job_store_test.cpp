#include "server/store/sqlite_job_store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "api/problem.h"
#include "core/base/error.h"
#include "server/store/sqlite_writer.h"
#include "tests/server/store/sqlite_version_1.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

constexpr UnixMillis kNow = 1'800'000'010'000;

class SqliteFile : public testing::Test {
protected:
    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "jobs.sqlite";

    void write(const std::string& sql) const {
        SqliteDatabase(file_, SqliteDatabase::Mode::ReadWrite).script(sql);
    }

    /// What is said when the file is opened; empty if it can be.
    [[nodiscard]] std::string refusal() const {
        try {
            const SqliteJobStore store(file_);
            return "";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::StorageFailure);
            return error.what();
        }
    }

    [[nodiscard]] static bool contains(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
};

TEST_F(SqliteFile, AFileOfVersion1IsBroughtUpToDateAndNothingIsLost) {
    write(kVersion1Database);
    SqliteJobStore store(file_);
    const std::string prefix = "0198f3a2-7c1e-7d42-9b57-00000000000";
    EXPECT_EQ(store.find_job(prefix + "3")->info.status, JobStatus::Successful);
    EXPECT_EQ(store.find_job(prefix + "3")->results.size(), 1U);
    EXPECT_EQ(store.find_job(prefix + "1")->info.parameters.radius, 2.5);

    const auto lost = store.take_back_expired(3, kNow);
    ASSERT_EQ(lost.size(), 1U);
    EXPECT_EQ(lost[0].job_id, prefix + "1");
    const auto waiting = store.waiting();
    ASSERT_EQ(waiting.size(), 2U);
    EXPECT_EQ(waiting[0].id, prefix + "1");
    EXPECT_EQ(waiting[0].points, 4321U);
    EXPECT_EQ(waiting[1].process, Task::Resample);
    const auto job = store.claim_next({.now = kNow, .lease_until = kNow + 1000, .rules = {}});
    EXPECT_EQ(job->info.attempt, 2);
}

TEST_F(SqliteFile, AFileThatIsUpToDateStaysAsItIs) {
    write(kVersion1Database);
    { const SqliteJobStore store(file_); }
    const SqliteJobStore store(file_);
    EXPECT_EQ(store.list_jobs({}).jobs.size(), 3U);
    EXPECT_EQ(SqliteDatabase(file_, SqliteDatabase::Mode::ReadOnly).user_version(), 3);
}

TEST_F(SqliteFile, AFileOfANewerProgramIsRefusedAndLeftAlone) {
    write("PRAGMA user_version = 99");
    EXPECT_TRUE(contains(refusal(), "newer lpf-server (schema 99")) << refusal();
    EXPECT_EQ(SqliteDatabase(file_, SqliteDatabase::Mode::ReadOnly).user_version(), 99);
}

TEST_F(SqliteFile, AFileThatIsNoDatabaseIsCalledDamaged) {
    std::ofstream(file_) << std::string(5000, 'x');
    EXPECT_TRUE(contains(refusal(), "damaged")) << refusal();
    EXPECT_TRUE(contains(refusal(), "jobs.sqlite")) << refusal();
}

TEST_F(SqliteFile, AFileWithDamagedPagesIsCalledDamaged) {
    write(kVersion1Database);
    { const SqliteJobStore store(file_); }
    std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
    for (int page = 1; page < 6; ++page) {
        file.seekp(page * 4096);
        file << std::string(200, '\xff');
    }
    file.close();
    EXPECT_TRUE(contains(refusal(), "damaged")) << refusal();
}

TEST_F(SqliteFile, AFolderInItsPlaceIsRefused) {
    std::filesystem::create_directory(file_);
    EXPECT_TRUE(contains(refusal(), "must be able to write")) << refusal();
}

TEST_F(SqliteFile, TheLogIsEmptyAfterAnOrderlyEnd) {
    write(kVersion1Database);
    { SqliteJobStore store(file_); }
    const auto log = file_.string() + "-wal";
    EXPECT_TRUE(!std::filesystem::exists(log) || std::filesystem::file_size(log) == 0);
}

TEST_F(SqliteFile, WithoutRoomAWriteIsRefusedAndNothingIsLost) {
    SqliteDatabase db(file_, SqliteDatabase::Mode::ReadWrite);
    db.script("CREATE TABLE t (x TEXT); PRAGMA max_page_count = 20;");
    SqliteWriter writer(db);
    std::size_t kept = 0;
    try {
        for (;; ++kept) {
            writer.write([&](SqliteDatabase& each) {
                each.run("INSERT INTO t VALUES (?)", {std::string(3000, 'a')});
            });
        }
    } catch (const ProblemException& error) {
        EXPECT_EQ(error.problem().status(), 507);
    }
    EXPECT_GT(kept, 5U);
    db.script("PRAGMA max_page_count = 1000");
    writer.write([&](SqliteDatabase& each) { each.run("INSERT INTO t VALUES ('more')"); });
    auto rows = db.query("SELECT count(*) FROM t");
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.integer(0), static_cast<std::int64_t>(kept + 1));
}

TEST_F(SqliteFile, AChangeThatThrowsIsUndoneAlone) {
    SqliteDatabase db(file_, SqliteDatabase::Mode::ReadWrite);
    db.script("CREATE TABLE t (x INTEGER)");
    SqliteWriter writer(db);
    std::atomic<int> refused = 0;
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t) {
            threads.emplace_back([&, t] {
                for (std::int64_t i = 0; i < 20; ++i) {
                    try {
                        writer.write([&](SqliteDatabase& each) {
                            each.run("INSERT INTO t VALUES (?)", {i});
                            if (t % 2 == 0) throw Error(ErrorCode::Internal, "no");
                        });
                    } catch (const Error&) {
                        ++refused;
                    }
                }
            });
        }
    }
    EXPECT_EQ(refused, 80);
    auto rows = db.query("SELECT count(*) FROM t");
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.integer(0), 80);
}

}  // namespace
}  // namespace lpf::server

#include "server/cores.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

constexpr std::uint64_t kMib = 1ULL << 20;

void write(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

TEST(Cores, ReadsTheQuotaOfControlGroupsVersion2) {
    const TemporaryFolder folder;
    write(folder.path() / "cpu.max", "150000 100000\n");
    EXPECT_EQ(cgroup_cores(folder.path()), 2);
    write(folder.path() / "cpu.max", "max 100000\n");
    EXPECT_EQ(cgroup_cores(folder.path()), 0);
}

TEST(Cores, ReadsTheQuotaOfControlGroupsVersion1) {
    const TemporaryFolder folder;
    write(folder.path() / "cpu" / "cpu.cfs_quota_us", "50000\n");
    write(folder.path() / "cpu" / "cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(cgroup_cores(folder.path()), 1);
    write(folder.path() / "cpu" / "cpu.cfs_quota_us", "-1\n");
    EXPECT_EQ(cgroup_cores(folder.path()), 0);
}

TEST(Cores, TheStrictestOfTheGroupsAboveCounts) {
    const TemporaryFolder folder;
    const auto own = folder.path() / "self";
    write(own, "5:cpu,cpuacct:/pod/box\n0::/pod/box\n");
    write(folder.path() / "pod" / "cpu.max", "300000 100000\n");
    write(folder.path() / "pod" / "box" / "cpu.max", "400000 100000\n");
    EXPECT_EQ(cgroup_cores(folder.path(), own), 3);
    write(folder.path() / "cpu" / "pod" / "box" / "cpu.cfs_quota_us", "200000\n");
    write(folder.path() / "cpu" / "pod" / "box" / "cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(cgroup_cores(folder.path(), own), 2);
}

TEST(Cores, ThereIsAlwaysOne) { EXPECT_GE(usable_cores(), 1); }

TEST(Memory, ReadsTheLimitOfControlGroupsVersion2) {
    const TemporaryFolder folder;
    write(folder.path() / "memory.max", "536870912\n");
    EXPECT_EQ(cgroup_memory(folder.path()), 512 * kMib);
    write(folder.path() / "memory.max", "max\n");
    EXPECT_EQ(cgroup_memory(folder.path()), 0U);
}

TEST(Memory, ReadsTheLimitOfControlGroupsVersion1) {
    const TemporaryFolder folder;
    const auto own = folder.path() / "self";
    write(own, "4:memory:/pod\n");
    write(folder.path() / "memory" / "memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_EQ(cgroup_memory(folder.path(), own), 0U);
    write(folder.path() / "memory" / "pod" / "memory.limit_in_bytes", "268435456\n");
    EXPECT_EQ(cgroup_memory(folder.path(), own), 256 * kMib);
}

TEST(Memory, ThereIsSome) { EXPECT_GT(usable_memory(), kMib); }

}  // namespace
}  // namespace lpf::server

#include "server/requests/preview_cache.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

void make_old(const fs::path& path, int minutes) {
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
}

TEST(PreviewCache, GivesBackWhatItKept) {
    const TemporaryFolder folder;
    PreviewCache cache(folder.path() / "previews");
    EXPECT_FALSE(cache.find("a"));
    ASSERT_TRUE(cache.keep("a", "bytes"));
    EXPECT_EQ(content(cache.find("a").value()), "bytes");
}

TEST(PreviewCache, IsEmptyAtTheStart) {
    const TemporaryFolder folder;
    { PreviewCache(folder.path() / "previews").keep("a", "bytes"); }
    EXPECT_FALSE(PreviewCache(folder.path() / "previews").find("a"));
}

TEST(PreviewCache, LetsTheLeastUsedGoWhenItIsFull) {
    const TemporaryFolder folder;
    PreviewCache cache(folder.path(), 10);
    ASSERT_TRUE(cache.keep("old", "1234"));
    ASSERT_TRUE(cache.keep("older", "1234"));
    make_old(folder.path() / "old", 5);
    make_old(folder.path() / "older", 9);
    ASSERT_TRUE(cache.keep("new", "1234"));
    EXPECT_FALSE(cache.find("older"));
    EXPECT_TRUE(cache.find("old"));
    EXPECT_TRUE(cache.find("new"));
}

TEST(PreviewCache, KeepsWhatWasUsedJustNow) {
    const TemporaryFolder folder;
    PreviewCache cache(folder.path(), 10);
    ASSERT_TRUE(cache.keep("a", "12345678"));
    cache.keep("b", "12345678");
    EXPECT_TRUE(cache.find("a"));
}

TEST(PreviewCache, DoesNotKeepWhatIsLargerThanAllOfIt) {
    const TemporaryFolder folder;
    PreviewCache cache(folder.path(), 10);
    EXPECT_FALSE(cache.keep("a", "12345678901"));
    EXPECT_FALSE(cache.find("a"));
}

}  // namespace
}  // namespace lpf::server

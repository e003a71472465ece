#include "server/gate/api_keys.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "tests/server/temporary_folder.h"

namespace lpf::gate {
namespace {

const std::string kKey = "correct-horse-battery-staple";

std::string fault_of(const std::string& file) {
    try {
        (void)ApiKeys::parse(file);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(ApiKeys, ALineOpensForItsKeyOnly) {
    const auto keys = ApiKeys::parse("# of the lab\n\n" + ApiKeys::line("scanner-1", kKey) +
                                     "\r\n" + ApiKeys::line("web", "another-key-of-size") + "\n");
    EXPECT_EQ(keys.size(), 2U);
    EXPECT_EQ(keys.name_of(kKey), "scanner-1");
    EXPECT_EQ(keys.name_of("another-key-of-size"), "web");
    EXPECT_FALSE(keys.name_of(kKey + "x"));
    EXPECT_FALSE(keys.name_of(""));
    EXPECT_FALSE(keys.name_of(ApiKeys::line("scanner-1", kKey)));
}

TEST(ApiKeys, TheLineHoldsTheHashAndNotTheKey) {
    const auto line = ApiKeys::line("a", "0123456789abcdef");
    EXPECT_EQ(line, "a:9f9f5111f7b27a781f1f1ddde5ebc2dd2b796bfc7365c9c28b548e564176929f");
}

TEST(ApiKeys, AnOldAndANewKeyMayShareAName) {
    const auto keys = ApiKeys::parse(ApiKeys::line("lab", kKey) + "\n" +
                                     ApiKeys::line("lab", "the-key-of-next-year") + "\n");
    EXPECT_EQ(keys.name_of(kKey), "lab");
    EXPECT_EQ(keys.name_of("the-key-of-next-year"), "lab");
}

TEST(ApiKeys, FaultsNameTheLineAndHideWhatStandsThere) {
    const auto good = ApiKeys::line("a", kKey) + "\n";
    EXPECT_NE(fault_of(good + "b\n").find("Line 2"), std::string::npos);
    EXPECT_NE(fault_of(good + "\nb:" + kKey + "\n").find("Line 3"), std::string::npos);
    EXPECT_EQ(fault_of(good + "b:" + kKey + "\n").find(kKey), std::string::npos);
    EXPECT_NE(fault_of("two words:" + good).find("Line 1"), std::string::npos);
    EXPECT_NE(fault_of(good + ApiKeys::line("b", kKey)).find("'a'"), std::string::npos);
    EXPECT_NE(fault_of("# nothing\n").find("no key"), std::string::npos);
}

TEST(ApiKeys, KeysThatAreEasilyGuessedAreRefused) {
    EXPECT_THROW((void)ApiKeys::line("a", "secret"), Error);
    EXPECT_THROW((void)ApiKeys::line("a", "a key with blanks in it"), Error);
    EXPECT_THROW((void)ApiKeys::line("", kKey), Error);
}

TEST(KeyFile, AWrongNewFileLeavesTheOldKeys) {
    const server::TemporaryFolder folder;
    const auto path = folder.path() / "keys";
    std::ofstream(path) << ApiKeys::line("old", kKey) << "\n";
    KeyFile file(path);
    std::ofstream(path) << "nonsense\n";
    EXPECT_THROW(file.reload(), Error);
    EXPECT_EQ(file.keys()->name_of(kKey), "old");
    std::ofstream(path) << ApiKeys::line("new", kKey) << "\n";
    file.reload();
    EXPECT_EQ(file.keys()->name_of(kKey), "new");
    EXPECT_THROW(KeyFile(folder.path() / "absent"), Error);
}

TEST(KeyFile, TellsWhoMayReadIt) {
    const server::TemporaryFolder folder;
    const auto path = folder.path() / "keys";
    std::ofstream(path) << ApiKeys::line("a", kKey) << "\n";
    using std::filesystem::perms;
    std::filesystem::permissions(path, perms::owner_read | perms::group_read);
    EXPECT_FALSE(KeyFile(path).readable_by_all());
    std::filesystem::permissions(path, perms::owner_read | perms::others_read);
    EXPECT_TRUE(KeyFile(path).readable_by_all());
}

TEST(BearerKey, IsTakenFromItsHeaderOnly) {
    EXPECT_EQ(bearer_key("Bearer abc"), "abc");
    EXPECT_EQ(bearer_key("bearer  abc "), "abc");
    EXPECT_FALSE(bearer_key("Basic abc"));
    EXPECT_FALSE(bearer_key("Bearer"));
    EXPECT_FALSE(bearer_key("Bearer  "));
    EXPECT_FALSE(bearer_key(""));
}

}  // namespace
}  // namespace lpf::gate

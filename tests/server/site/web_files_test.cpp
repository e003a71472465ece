#include "server/site/web_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "api/problem.h"
#include "core/base/error.h"
#include "server/store/data_dir.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

class WebFiles : public testing::Test {
protected:
    void SetUp() override {
        std::filesystem::create_directories(web_ / "js");
        for (const char* name : {"index.html", "js/app.js", ".secret"})
            std::ofstream(web_ / name) << name;
        std::ofstream(folder_.path() / "outside.txt") << "outside";
        std::filesystem::create_symlink(folder_.path() / "outside.txt", web_ / "link.txt");
    }

    TemporaryFolder folder_;
    std::filesystem::path web_ = folder_.path() / "web";
};

TEST_F(WebFiles, FindsFilesOfTheFolder) {
    EXPECT_EQ(web_file(web_, "/")->filename(), "index.html");
    EXPECT_EQ(web_file(web_, "/js/app.js")->filename(), "app.js");
}

TEST_F(WebFiles, LeavesTheFolderOnNoWay) {
    for (const char* path :
         {"/../outside.txt", "/js/../../outside.txt", "//etc/passwd", "/link.txt", "/.secret",
          "/js", "/js/", "/nothing", "", "/js\\app.js", "/./index.html", "/js//app.js"}) {
        const auto file = web_file(web_, path);
        EXPECT_FALSE(file && file->filename() != "app.js") << path;
        if (std::string(path) != "/js//app.js") {
            EXPECT_FALSE(file) << path;
        }
    }
}

TEST_F(WebFiles, ThePageIsFoundBesideTheProgram) {
    const auto root = folder_.path() / "installed";
    const auto page = root / "share" / "lpf-server" / "web";
    std::filesystem::create_directories(root / "bin");
    std::filesystem::create_directories(page);
    const auto program = root / "bin" / "lpf-server";
    std::ofstream(program) << "program";
    EXPECT_TRUE(web_dir_of(program).empty()) << "a folder without index.html is no page";
    std::ofstream(page / "index.html") << "page";
    EXPECT_EQ(web_dir_of(program), std::filesystem::canonical(page));
    EXPECT_TRUE(web_dir_of(root / "bin" / "missing").empty());
}

TEST_F(WebFiles, WithoutAFolderThereIsNothing) { EXPECT_FALSE(web_file({}, "/")); }

TEST_F(WebFiles, TypesFollowTheEnding) {
    EXPECT_EQ(web_type("a.html"), "text/html; charset=utf-8");
    EXPECT_EQ(web_type("a.wasm"), "application/wasm");
    EXPECT_EQ(web_type("a.unknown"), "application/octet-stream");
}

TEST(PlainIndex, NamesTheServiceAndLinksToTheApi) {
    const std::string page = plain_index("1.2.3");
    for (const char* part : {"<html lang=\"en\">", "<title>LPF Server</title>", "/v1/openapi.json",
                             "curl --data-binary", "1.2.3", "name=\"viewport\""})
        EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(DataDir, IsLockedForOneServer) {
    const TemporaryFolder folder;
    const DataDir first(folder.path() / "data");
    try {
        const DataDir second(folder.path() / "data");
        FAIL() << "two servers on one folder";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("in use by another server"), std::string::npos);
    }
}

TEST(DataDir, IsFreeAgainAfterTheServerLeft) {
    const TemporaryFolder folder;
    { const DataDir first(folder.path()); }
    EXPECT_NO_THROW(DataDir{folder.path()});
}

TEST(DataDir, SaysThatItCannotBeWrittenTo) {
    try {
        const DataDir data("/proc/lpf");
        FAIL() << "/proc takes no folders";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("--data-dir"), std::string::npos);
    }
}

TEST(DataDir, RefusesMoreThanTheDiskHolds) {
    const TemporaryFolder folder;
    const DataDir data(folder.path());
    try {
        data.require_space(1ULL << 60, Limits{});
        FAIL() << "an exbibyte fits on no disk";
    } catch (const ProblemException& error) {
        EXPECT_EQ(error.problem().status(), 507);
    }
}

}  // namespace
}  // namespace lpf::server

#include "server/blob_store.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "core/base/error.h"
#include "server/store/file_blob_store.h"
#include "server/store/mapped_file.h"
#include "server/store/sha256.h"
#include "tests/server/store/stores.h"
#include "tests/server/temporary_folder.h"

namespace lpf::server {
namespace {

class BlobStoreConformance : public testing::TestWithParam<StoreMaker<BlobStore>> {
protected:
    TemporaryFolder folder_;
    std::unique_ptr<BlobStore> store_ = GetParam().make(folder_.path());

    [[nodiscard]] std::string content(const std::string& digest) const {
        return std::string(MappedFile(store_->local_file(digest)).text());
    }
};

TEST_P(BlobStoreConformance, GivesBackWhatWasPut) {
    const std::string digest = store_->put("hello");
    EXPECT_EQ(digest, "2cf24dba5fb0a30e26e83b2ac5b9e29e1b161e5c1fa7425e73043362938b9824");
    EXPECT_EQ(store_->size(digest), 5U);
    EXPECT_EQ(content(digest), "hello");
}

TEST_P(BlobStoreConformance, KeepsAnEmptyBlob) {
    const std::string digest = store_->put("");
    EXPECT_EQ(store_->size(digest), 0U);
    EXPECT_EQ(content(digest), "");
}

TEST_P(BlobStoreConformance, PutsEqualBytesOnce) {
    EXPECT_EQ(store_->put("same"), store_->put("same"));
    EXPECT_EQ(content(sha256_of("same")), "same");
}

TEST_P(BlobStoreConformance, WritesPieceByPiece) {
    const auto writer = store_->create();
    writer->write("ab");
    writer->write("cd");
    EXPECT_EQ(writer->size(), 4U);
    EXPECT_EQ(MappedFile(writer->staged()).text(), "abcd");
    EXPECT_EQ(writer->digest(), sha256_of("abcd"));
    EXPECT_EQ(writer->commit(), sha256_of("abcd"));
}

TEST_P(BlobStoreConformance, KeepsNothingThatWasNotCommitted) {
    store_->create()->write("lost");
    EXPECT_FALSE(store_->size(sha256_of("lost")));
}

TEST_P(BlobStoreConformance, RemovesAndToleratesRemovingTwice) {
    const std::string digest = store_->put("gone");
    store_->remove(digest);
    store_->remove(digest);
    EXPECT_FALSE(store_->size(digest));
    EXPECT_THROW((void)store_->local_file(digest), Error);
}

TEST_P(BlobStoreConformance, OutlivesItsObject) {
    const std::string digest = store_->put("durable");
    store_.reset();
    store_ = GetParam().make(folder_.path());
    EXPECT_EQ(content(digest), "durable");
}

TEST_P(BlobStoreConformance, PutsOnlyUnknownOldBlobsAside) {
    const std::string known = store_->put("known");
    const std::string unknown = store_->put("unknown");
    const auto is_known = [&](const std::string& digest) { return digest == known; };
    EXPECT_EQ(store_->quarantine_unknown(is_known, std::chrono::hours(1)), 0U);
    EXPECT_EQ(store_->quarantine_unknown(is_known, std::chrono::seconds(-1)), 1U);
    EXPECT_TRUE(store_->size(known));
    EXPECT_FALSE(store_->size(unknown));
}

TEST_P(BlobStoreConformance, RefusesNamesThatAreNoDigests) {
    EXPECT_THROW((void)store_->size("../../etc/passwd"), Error);
}

TEST_P(BlobStoreConformance, CountsItsBytesEachFileOnce) {
    EXPECT_EQ(store_->stored_bytes(), 0U);
    const std::string digest = store_->put("12345");
    store_->put("12345");
    store_->put("123");
    EXPECT_EQ(store_->stored_bytes(), 8U);
    store_->remove(digest);
    EXPECT_EQ(store_->stored_bytes(), 3U);
    store_.reset();
    store_ = GetParam().make(folder_.path());
    EXPECT_EQ(store_->stored_bytes(), 3U);
    store_->quarantine_unknown([](const std::string&) { return false; }, std::chrono::seconds(-1));
    EXPECT_EQ(store_->stored_bytes(), 0U);
}

TEST_P(BlobStoreConformance, ManyThreadsPutEqualAndOtherBytes) {
    {
        std::vector<std::jthread> threads;
        for (int t = 0; t < 8; ++t) {
            threads.emplace_back([this, t] {
                for (int i = 0; i < 20; ++i) {
                    EXPECT_EQ(content(store_->put("common" + std::to_string(i))),
                              "common" + std::to_string(i));
                    store_->put("own" + std::to_string(t));
                }
            });
        }
    }
    std::size_t expected = 8 * 4;
    for (int i = 0; i < 20; ++i) expected += ("common" + std::to_string(i)).size();
    EXPECT_EQ(store_->stored_bytes(), expected);
}

INSTANTIATE_TEST_SUITE_P(All, BlobStoreConformance, testing::ValuesIn(blob_stores()),
                         [](const auto& tested) { return tested.param.name; });

TEST(FileBlobStore, PutsBlobsIntoFoldersByTheirFirstByte) {
    const TemporaryFolder folder;
    FileBlobStore store(folder.path());
    const std::string digest = store.put("hello");
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "blobs" / "2c" / digest));
}

TEST(FileBlobStore, StartsWithNoLeftOverTemporaryFiles) {
    const TemporaryFolder folder;
    { const FileBlobStore store(folder.path()); }
    const auto left = folder.path() / "tmp" / "half";
    std::ofstream(left) << "half an upload";
    const FileBlobStore store(folder.path());
    EXPECT_FALSE(std::filesystem::exists(left));
}

TEST(FileBlobStore, QuarantinedFilesStayForADay) {
    const TemporaryFolder folder;
    FileBlobStore store(folder.path());
    const std::string digest = store.put("unknown");
    const auto nobody = [](const std::string&) { return false; };
    EXPECT_EQ(store.quarantine_unknown(nobody, std::chrono::seconds(-1)), 1U);
    EXPECT_EQ(store.quarantine_unknown(nobody, std::chrono::seconds(-1)), 0U);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "quarantine" / digest));
}

}  // namespace
}  // namespace lpf::server

#include "tests/server/store/stores.h"

#include "server/store/file_blob_store.h"
#include "server/store/sqlite_job_store.h"

namespace lpf::server {

std::vector<StoreMaker<JobStore>> job_stores() {
    return {{"Sqlite", [](const auto& folder) {
                 return std::make_unique<SqliteJobStore>(folder / "jobs.sqlite");
             }}};
}

std::vector<StoreMaker<BlobStore>> blob_stores() {
    return {{"Files", [](const auto& folder) { return std::make_unique<FileBlobStore>(folder); }}};
}

}  // namespace lpf::server

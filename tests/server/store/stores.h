#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/blob_store.h"
#include "server/job_store.h"

namespace lpf::server {

/// One way to make a store on an empty folder, or to open again what was made there.
template <typename Store>
struct StoreMaker {
    std::string name;
    std::function<std::unique_ptr<Store>(const std::filesystem::path&)> make;
};

/// The implementations that the conformance suites run over: a further one is registered here.
[[nodiscard]] std::vector<StoreMaker<JobStore>> job_stores();
[[nodiscard]] std::vector<StoreMaker<BlobStore>> blob_stores();

}  // namespace lpf::server

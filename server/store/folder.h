#pragma once

#include <filesystem>

namespace lpf::server {

/// Makes the names in a folder durable: a file that was synced is lost all the same if its folder
/// was not. @throws Error{StorageFailure}
void sync_folder(const std::filesystem::path& folder);

}  // namespace lpf::server

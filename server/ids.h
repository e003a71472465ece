#pragma once

#include <string>

namespace lpf::server {

/// A new identifier: a version 7 UUID, so that identifiers sort by time of creation.
[[nodiscard]] std::string new_id();

}  // namespace lpf::server

#pragma once

#include <string>

namespace lpf::server {

/// Asks a running server for /healthz. For containers, whose images hold no curl.
[[nodiscard]] bool is_healthy(const std::string& host, int port);

}  // namespace lpf::server

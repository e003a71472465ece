#pragma once

#include "server/http/listener.h"

namespace lpf::server {

/// How long the answer to a request without a body takes to make.
[[nodiscard]] http::Pace pace_of(const http::Request& request);

}  // namespace lpf::server

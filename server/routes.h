#pragma once

#include "server/services.h"
#include "server/site/router.h"

namespace lpf::server {

/// The service: everything under /v1/, and the web page at /.
[[nodiscard]] Router public_routes(Services& services);

/// For operators, on a port of its own.
[[nodiscard]] Router admin_routes(Services& services);

}  // namespace lpf::server

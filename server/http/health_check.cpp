#include "server/http/health_check.h"

#include <httplib.h>

namespace lpf::server {

bool is_healthy(const std::string& host, int port) {
    constexpr time_t kSeconds = 3;
    // A server that listens everywhere is asked on the loopback.
    httplib::Client client(host == "0.0.0.0" || host == "::" ? "127.0.0.1" : host, port);
    client.set_connection_timeout(kSeconds);
    client.set_read_timeout(kSeconds);
    const auto response = client.Get("/healthz");
    return response && response->status == 200;
}

}  // namespace lpf::server

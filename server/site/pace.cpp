#include "server/site/pace.h"

namespace lpf::server {

http::Pace pace_of(const http::Request& request) {
    if (request.path == "/healthz") return http::Pace::AtOnce;
    // These may decode a whole file, and wait for a seat to do so.
    const bool may_decode = request.path.ends_with("/results/points") ||
                            request.path.ends_with("/preview") || request.path.ends_with("/retry");
    return may_decode ? http::Pace::Long : http::Pace::Quick;
}

}  // namespace lpf::server

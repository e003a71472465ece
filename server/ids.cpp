#include "server/ids.h"

#include <sys/random.h>

#include <array>

#include "api/uuid.h"
#include "core/base/error.h"
#include "server/clock.h"

namespace lpf::server {

std::string new_id() {
    std::array<std::uint8_t, 10> random{};
    if (::getrandom(random.data(), random.size(), 0) != static_cast<ssize_t>(random.size()))
        throw Error(ErrorCode::Internal, "The system gave no random bytes.");
    return make_uuid7(now_millis(), random);
}

}  // namespace lpf::server

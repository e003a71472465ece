#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace lpf {

/// A link as OGC API writes it.
struct Link {
    std::string href;
    std::string rel;
    std::string type = "application/json";
    std::string title = {};
};

[[nodiscard]] nlohmann::json to_json(const Link& link);

}  // namespace lpf

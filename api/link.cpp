#include "api/link.h"

#include <nlohmann/json.hpp>

namespace lpf {

nlohmann::json to_json(const Link& link) {
    nlohmann::json json = {{"href", link.href}, {"rel", link.rel}, {"type", link.type}};
    if (!link.title.empty()) json["title"] = link.title;
    return json;
}

}  // namespace lpf

#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "api/codec/document.h"
#include "api/time_text.h"
#include "core/base/error.h"

/// Reading back what the service itself has written; whatever does not fit is damage.
namespace lpf::stored {

[[noreturn]] inline void damaged(const std::string& name) {
    throw Error(ErrorCode::StorageFailure, "A stored record is damaged at \"" + name + "\".");
}

/// The member `name`, which must be there and of type T.
template <typename T>
[[nodiscard]] T need(const nlohmann::json& json, const std::string& name) {
    const auto value = json.find(name);
    if (value == json.end()) damaged(name);
    try {
        return value->get<T>();
    } catch (const nlohmann::json::exception&) {
        damaged(name);
    }
}

/// The member `name` if it is there.
template <typename T>
[[nodiscard]] std::optional<T> maybe(const nlohmann::json& json, const std::string& name) {
    if (!json.contains(name)) return std::nullopt;
    return need<T>(json, name);
}

[[nodiscard]] inline std::optional<UnixMillis> maybe_time(const nlohmann::json& json,
                                                          const std::string& name) {
    const auto text = maybe<std::string>(json, name);
    if (!text) return std::nullopt;
    const auto time = from_rfc3339(*text);
    if (!time) damaged(name);
    return time;
}

[[nodiscard]] inline UnixMillis need_time(const nlohmann::json& json, const std::string& name) {
    const auto time = maybe_time(json, name);
    if (!time) damaged(name);
    return *time;
}

[[nodiscard]] inline nlohmann::json warnings_to_json(const std::vector<Warning>& warnings) {
    nlohmann::json json = nlohmann::json::array();
    for (const Warning& w : warnings) json.push_back({{"code", w.code}, {"detail", w.detail}});
    return json;
}

[[nodiscard]] inline std::vector<Warning> warnings_from_json(const nlohmann::json& json) {
    std::vector<Warning> warnings;
    for (const auto& w : json.value("warnings", nlohmann::json::array())) {
        warnings.push_back({need<std::string>(w, "code"), need<std::string>(w, "detail")});
    }
    return warnings;
}

}  // namespace lpf::stored

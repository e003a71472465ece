#include "server/http/message.h"

#include <algorithm>
#include <cctype>

namespace lpf::http {
namespace {

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) ==
               std::tolower(static_cast<unsigned char>(y));
    });
}

std::optional<std::string> find(const Fields& fields, std::string_view name) {
    for (const auto& [key, value] : fields)
        if (equal_ignoring_case(key, name)) return value;
    return std::nullopt;
}

}  // namespace

std::optional<std::string> Request::header(std::string_view name) const {
    return find(headers, name);
}

std::optional<std::string> Request::query_value(std::string_view name) const {
    for (const auto& [field, value] : query)
        if (field == name) return value;
    return std::nullopt;
}

Response& Response::set(const std::string& name, std::string value) {
    std::erase_if(headers,
                  [&](const auto& field) { return equal_ignoring_case(field.first, name); });
    headers.emplace_back(name, std::move(value));
    return *this;
}

std::optional<std::string> Response::header(std::string_view name) const {
    return find(headers, name);
}

}  // namespace lpf::http

#include "api/json_text.h"

#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "api/problem.h"

namespace lpf {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(ProblemCode problem, std::string detail, std::string_view limit_name,
                         std::uint64_t limit) {
    throw ProblemException(Problem{.problem = problem,
                                   .detail = std::move(detail),
                                   .members = {{"limitName", std::string(limit_name)},
                                               {"limit", static_cast<std::int64_t>(limit)}}});
}

/// Watches a document while it is read, so that nothing over a limit is ever built.
class Guard {
public:
    explicit Guard(const Limits& limits) : limits_(limits) {}

    bool operator()(int depth, json::parse_event_t event, const json& value) {
        switch (event) {
            case json::parse_event_t::object_start: keys_.emplace_back(); [[fallthrough]];
            case json::parse_event_t::array_start: check_depth(depth); break;
            case json::parse_event_t::object_end: keys_.pop_back(); break;
            case json::parse_event_t::key:
                check_string(value);
                check_key(value.get_ref<const std::string&>());
                break;
            case json::parse_event_t::value:
                if (value.is_string()) check_string(value);
                break;
            case json::parse_event_t::array_end: break;
        }
        return true;
    }

private:
    void check_depth(int depth) const {
        if (static_cast<std::uint64_t>(depth) < limits_.json_depth) return;
        refuse(ProblemCode::LimitExceeded,
               "The JSON is nested deeper than the limit jsonDepth of " +
                   std::to_string(limits_.json_depth) + " levels.",
               "jsonDepth", limits_.json_depth);
    }

    void check_string(const json& value) const {
        if (value.get_ref<const std::string&>().size() <= limits_.json_string_bytes) return;
        refuse(ProblemCode::LimitExceeded,
               "A string in the JSON is longer than the limit jsonStringBytes of " +
                   std::to_string(limits_.json_string_bytes) + " bytes.",
               "jsonStringBytes", limits_.json_string_bytes);
    }

    void check_key(const std::string& key) {
        if (keys_.back().insert(key).second) return;
        throw ProblemException(ProblemCode::MalformedJson,
                               "The name \"" + key + "\" stands twice in one JSON object.");
    }

    const Limits& limits_;
    std::vector<std::set<std::string>> keys_;  // of the objects that are open
};

}  // namespace

json parse_json(std::string_view text, const Limits& limits) {
    if (text.size() > limits.json_bytes) {
        refuse(ProblemCode::PayloadTooLarge,
               "The JSON has " + std::to_string(text.size()) + " bytes; the limit jsonBytes is " +
                   std::to_string(limits.json_bytes) + ".",
               "jsonBytes", limits.json_bytes);
    }
    Guard guard(limits);
    try {
        return json::parse(text, [&](int depth, json::parse_event_t event, const json& value) {
            return guard(depth, event, value);
        });
    } catch (const json::parse_error& error) {
        throw ProblemException(
            Problem{.problem = ProblemCode::MalformedJson,
                    .detail = "The JSON cannot be read at byte " + std::to_string(error.byte) + ".",
                    .members = {{"byte", static_cast<std::int64_t>(error.byte)}}});
    } catch (const json::out_of_range&) {
        throw ProblemException(ProblemCode::MalformedJson,
                               "A number in the JSON is too large for a double.");
    }
}

std::string dump_json(const json& json) {
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace lpf

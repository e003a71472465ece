#include "api/openapi/parts.h"

#include <algorithm>
#include <map>

#include "api/uuid.h"

namespace lpf::openapi {
namespace {

/// What any request can meet, whatever it asks for.
constexpr ProblemCode kAnywhere[] = {ProblemCode::MalformedRequest, ProblemCode::RequestTimeout,
                                     ProblemCode::UriTooLong,       ProblemCode::HeadTooLarge,
                                     ProblemCode::Forbidden,        ProblemCode::Internal,
                                     ProblemCode::Unavailable};

/// What any request to a protected path can meet.
constexpr ProblemCode kProtected[] = {ProblemCode::Unauthorized, ProblemCode::RateLimited};

/// Headers that go with a status.
std::vector<std::string_view> headers_of(int status) {
    if (status == 401) return {"WWW-Authenticate"};
    if (status == 429)
        return {"Retry-After", "RateLimit-Limit", "RateLimit-Remaining", "RateLimit-Reset"};
    if (status == 503) return {"Retry-After"};
    return {};
}

Json described(Json schema, std::string_view description) {
    if (!description.empty()) schema["description"] = description;
    return schema;
}

Json problem_response(const std::vector<ProblemCode>& problems) {
    std::string description;
    for (const ProblemCode problem : problems) {
        const ProblemKind& kind = kind_of(problem);
        if (!description.empty()) description += " ";
        description += "`" + std::string(kind.code) + "`: " + std::string(kind.title) + ".";
    }
    const Json example = to_json(Problem{.problem = problems.front(),
                                         .detail = "One sentence about what was wrong, where, and "
                                                   "what would be right."});
    Json response = {{"description", description},
                     {"content",
                      {{std::string(kProblemMediaType),
                        {{"schema", component("Problem")}, {"example", example}}}}}};
    for (const std::string_view header : headers_of(kind_of(problems.front()).status))
        response["headers"][std::string(header)] = component(header, "headers");
    return response;
}

}  // namespace

Json object(std::string_view description, const std::vector<Field>& fields) {
    Json schema = {{"type", "object"},
                   {"additionalProperties", false},
                   {"properties", Json::object()},
                   {"required", Json::array()}};
    for (const Field& field : fields) {
        schema["properties"][field.name] = field.schema;
        if (field.required) schema["required"].push_back(field.name);
    }
    return described(std::move(schema), description);
}

Json map_of(std::string_view description, const Json& values) {
    return described({{"type", "object"}, {"additionalProperties", values}}, description);
}

Json array_of(const Json& items, std::string_view description) {
    return described({{"type", "array"}, {"items", items}}, description);
}

Json text(std::string_view description) { return described({{"type", "string"}}, description); }

Json integer(std::string_view description, int minimum) {
    return described({{"type", "integer"}, {"minimum", minimum}}, description);
}

Json number(std::string_view description) { return described({{"type", "number"}}, description); }

Json boolean(std::string_view description) { return described({{"type", "boolean"}}, description); }

Json time(std::string_view description) {
    return described({{"type", "string"}, {"format", "date-time"}}, description);
}

Json id(std::string_view description) {
    return described({{"type", "string"}, {"pattern", kUuidPattern}}, description);
}

Json phase_progress() {
    return object("Progress within the phase.", {{"done", integer("Units done.")},
                                                 {"total", integer("Units in all.")},
                                                 {"unit", text("What is counted.")}});
}

Json one_of(std::string_view description, const std::vector<std::string_view>& names) {
    return described({{"type", "string"}, {"enum", names}}, description);
}

Json component(std::string_view name, std::string_view section) {
    return {{"$ref", "#/components/" + std::string(section) + "/" + std::string(name)}};
}

Operation::Operation(std::string_view operation_id, std::string_view tag, std::string_view summary,
                     std::string_view description) {
    json_ = {{"operationId", operation_id},
             {"tags", Json::array({tag})},
             {"summary", summary},
             {"responses", Json::object()}};
    if (!description.empty()) json_["description"] = description;
}

Operation& Operation::parameter(std::string_view name) {
    json_["parameters"].push_back(component(name, "parameters"));
    return *this;
}

Operation& Operation::body(std::string_view description, const Json& content) {
    json_["requestBody"] = {{"description", description}, {"required", true}, {"content", content}};
    return *this;
}

Operation& Operation::answers(int status, std::string_view description, const Json& content,
                              std::initializer_list<std::string_view> headers) {
    Json& response = json_["responses"][std::to_string(status)];
    response["description"] = description;
    if (!content.is_null()) response["content"] = content;
    for (const std::string_view header : headers) {
        response["headers"][std::string(header)] = component(header, "headers");
    }
    return *this;
}

Operation& Operation::fails(std::initializer_list<ProblemCode> problems) {
    problems_.insert(problems_.end(), problems);
    return *this;
}

Operation& Operation::open_to_all() {
    open_ = true;
    json_["security"] = Json::array();
    return *this;
}

Json Operation::json() const {
    std::vector<ProblemCode> problems = problems_;
    problems.insert(problems.end(), std::begin(kAnywhere), std::end(kAnywhere));
    if (!open_) problems.insert(problems.end(), std::begin(kProtected), std::end(kProtected));
    std::map<int, std::vector<ProblemCode>> by_status;
    for (const ProblemCode problem : problems) {
        auto& same = by_status[kind_of(problem).status];
        if (std::ranges::find(same, problem) == same.end()) same.push_back(problem);
    }
    Json result = json_;
    for (const auto& [status, same] : by_status) {
        result["responses"][std::to_string(status)].update(problem_response(same), true);
    }
    for (auto& [status, response] : result["responses"].items())
        response["headers"]["X-Request-Id"] = component("X-Request-Id", "headers");
    return result;
}

Json Operation::head() const {
    Json result = json();
    result["operationId"] = result["operationId"].get<std::string>() + "Head";
    result["summary"] = result["summary"].get<std::string>() + " (head only)";
    for (auto& [status, response] : result["responses"].items()) response.erase("content");
    return result;
}

Json json_content(const Json& schema, const Json& example) {
    Json content = {{"schema", schema}};
    if (!example.is_null()) content["example"] = example;
    return {{"application/json", content}};
}

Json file_content(std::initializer_list<std::string_view> media_types) {
    Json content = Json::object();
    for (const std::string_view type : media_types) {
        content[std::string(type)] = {{"schema", {{"contentMediaType", type}}}};
    }
    return content;
}

}  // namespace lpf::openapi

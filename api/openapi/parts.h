#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "api/problem.h"

/// The words that the OpenAPI document is written in.
namespace lpf::openapi {

using Json = nlohmann::json;

/// A member of an object of ours.
struct Field {
    std::string name;
    Json schema;
    bool required = true;
};

/// An object with these members and no other.
[[nodiscard]] Json object(std::string_view description, const std::vector<Field>& fields);

/// An object whose member names are data; their values follow the schema.
[[nodiscard]] Json map_of(std::string_view description, const Json& values);

[[nodiscard]] Json array_of(const Json& items, std::string_view description = "");
[[nodiscard]] Json text(std::string_view description);
[[nodiscard]] Json integer(std::string_view description, int minimum = 0);
[[nodiscard]] Json number(std::string_view description);
[[nodiscard]] Json boolean(std::string_view description);
[[nodiscard]] Json time(std::string_view description);
[[nodiscard]] Json id(std::string_view description);
/// The `phaseProgress` of a job and of its events.
[[nodiscard]] Json phase_progress();
[[nodiscard]] Json one_of(std::string_view description, const std::vector<std::string_view>& names);

/// {"$ref": "#/components/SECTION/NAME"}
[[nodiscard]] Json component(std::string_view name, std::string_view section = "schemas");

/// One operation on a path, built up step by step.
class Operation {
public:
    Operation(std::string_view id, std::string_view tag, std::string_view summary,
              std::string_view description = "");

    Operation& parameter(std::string_view name);  ///< one of components/parameters
    Operation& body(std::string_view description, const Json& content);

    /// A successful answer. Headers are names of components/headers.
    Operation& answers(int status, std::string_view description, const Json& content = {},
                       std::initializer_list<std::string_view> headers = {});

    /// The problems that this operation can answer with, besides those that any can.
    Operation& fails(std::initializer_list<ProblemCode> problems);

    /// Takes requests without a key.
    Operation& open_to_all();

    /// The finished object.
    [[nodiscard]] Json json() const;

    /// The same for HEAD: same statuses and headers, no content.
    [[nodiscard]] Json head() const;

private:
    Json json_;
    std::vector<ProblemCode> problems_;
    bool open_ = false;
};

/// {"application/json": {"schema": ..., "example": ...}}
[[nodiscard]] Json json_content(const Json& schema, const Json& example = {});

/// A binary file of any of these media types.
[[nodiscard]] Json file_content(std::initializer_list<std::string_view> media_types);

}  // namespace lpf::openapi

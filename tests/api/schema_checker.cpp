#include "tests/api/schema_checker.h"

#include <algorithm>
#include <regex>
#include <set>

namespace lpf::test {
namespace {

using nlohmann::json;

const std::set<std::string> kWords{"$ref",
                                   "type",
                                   "enum",
                                   "const",
                                   "properties",
                                   "required",
                                   "additionalProperties",
                                   "items",
                                   "oneOf",
                                   "anyOf",
                                   "minimum",
                                   "maximum",
                                   "exclusiveMinimum",
                                   "minItems",
                                   "maxItems",
                                   "pattern",
                                   "format",
                                   "title",
                                   "description",
                                   "default",
                                   "x-unit",
                                   "x-auto",
                                   "contentMediaType",
                                   "contentSchema"};

bool has_type(const json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "number") return value.is_number();
    return type == "integer" && value.is_number_integer();
}

class Checker {
public:
    explicit Checker(const json& document) : document_(document) {}

    std::vector<std::string> faults;

    void check(const json& value, const json& schema, const std::string& place) {
        for (const auto& [word, unused] : schema.items()) {
            if (!kWords.contains(word)) fault(place, "unknown word " + word);
        }
        if (schema.contains("$ref")) {
            const auto pointer = schema["$ref"].get<std::string>().substr(1);
            check(value, document_.at(json::json_pointer(pointer)), place);
        }
        check_type(value, schema, place);
        check_alternatives(value, schema, place);
        if (value.is_number()) check_number(value, schema, place);
        if (value.is_object()) check_object(value, schema, place);
        if (value.is_array()) check_array(value, schema, place);
        if (value.is_string() && schema.contains("pattern")) {
            const std::regex pattern(schema["pattern"].get<std::string>());
            if (!std::regex_search(value.get<std::string>(), pattern)) fault(place, "pattern");
        }
    }

private:
    void fault(const std::string& place, const std::string& what) {
        faults.push_back(place + ": " + what);
    }

    void check_type(const json& value, const json& schema, const std::string& place) {
        if (schema.contains("type")) {
            const json& type = schema["type"];
            const json types = type.is_array() ? type : json::array({type});
            const bool fits = std::ranges::any_of(
                types, [&](const json& t) { return has_type(value, t.get<std::string>()); });
            if (!fits) fault(place, "type is not " + type.dump() + " but " + value.dump());
        }
        if (schema.contains("const") && value != schema["const"]) fault(place, "const");
        if (schema.contains("enum") &&
            std::ranges::find(schema["enum"], value) == schema["enum"].end()) {
            fault(place, "not of the enum: " + value.dump());
        }
    }

    void check_alternatives(const json& value, const json& schema, const std::string& place) {
        for (const char* word : {"oneOf", "anyOf"}) {
            if (!schema.contains(word)) continue;
            std::ptrdiff_t fitting = 0;
            for (const json& option : schema[word]) {
                Checker inner(document_);
                inner.check(value, option, place);
                if (inner.faults.empty()) ++fitting;
            }
            const bool right = std::string(word) == "oneOf" ? fitting == 1 : fitting >= 1;
            if (!right) fault(place, std::to_string(fitting) + " of " + word + " fit");
        }
    }

    void check_number(const json& value, const json& schema, const std::string& place) {
        const auto number = value.get<double>();
        if (schema.contains("minimum") && number < schema["minimum"].get<double>()) {
            fault(place, "below the minimum");
        }
        if (schema.contains("exclusiveMinimum") &&
            number <= schema["exclusiveMinimum"].get<double>()) {
            fault(place, "not above the minimum");
        }
        if (schema.contains("maximum") && number > schema["maximum"].get<double>()) {
            fault(place, "above the maximum");
        }
    }

    void check_object(const json& value, const json& schema, const std::string& place) {
        for (const json& name : schema.value("required", json::array())) {
            if (!value.contains(name.get<std::string>())) fault(place, name.dump() + " is missing");
        }
        const json properties = schema.value("properties", json::object());
        const json rest = schema.value("additionalProperties", json(true));
        for (const auto& [name, member] : value.items()) {
            if (properties.contains(name)) {
                check(member, properties[name], place + "/" + name);
            } else if (rest.is_object()) {
                check(member, rest, place + "/" + name);
            } else if (rest == false) {
                fault(place, "unexpected member " + name);
            }
        }
    }

    void check_array(const json& value, const json& schema, const std::string& place) {
        if (value.size() < schema.value("minItems", std::size_t{0})) fault(place, "too short");
        if (schema.contains("maxItems") && value.size() > schema["maxItems"].get<std::size_t>()) {
            fault(place, "too long");
        }
        if (!schema.contains("items")) return;
        for (std::size_t i = 0; i < value.size(); ++i) {
            check(value[i], schema["items"], place + "/" + std::to_string(i));
        }
    }

    const json& document_;
};

}  // namespace

std::vector<std::string> schema_faults(const json& value, const json& schema,
                                       const json& document) {
    Checker checker(document);
    checker.check(value, schema, "");
    return checker.faults;
}

std::vector<std::string> component_faults(const json& value, const std::string& name,
                                          const json& document) {
    return schema_faults(value, document.at("components").at("schemas").at(name), document);
}

}  // namespace lpf::test

#include "api/processes.h"

#include <nlohmann/json.hpp>
#include <string>

#include "api/link.h"
#include "api/parameters.h"
#include "api/uuid.h"

namespace lpf {
namespace {

using nlohmann::json;

struct ProcessText {
    std::string_view title;
    std::string_view description;
};

ProcessText text_of(Task task) {
    switch (task) {
        case Task::Denoise:
            return {"Denoise",
                    "Moves every point to the consensus of the fields around it. The points keep "
                    "their number, order and attributes."};
        case Task::Resample:
            return {"Resample",
                    "Makes new points from the consensus of all fields, as dense as wanted. They "
                    "carry the attributes of the nearest point."};
        case Task::Analyze:
            return {"Analyze",
                    "Learns the dictionary of local shapes and describes every part of the shape "
                    "by a few of its atoms."};
    }
    return {};
}

json shape_schema() {
    return {{"oneOf",
             {{{"type", "string"}, {"pattern", kUuidPattern}},
              {{"type", "object"},
               {"additionalProperties", false},
               {"required", json::array({"href"})},
               {"properties", {{"href", {{"type", "string"}, {"pattern", "^/v1/shapes/"}}}}}}}}};
}

json inputs_of(Task task, const Limits& limits) {
    json inputs = {{"shape",
                    {{"title", "The shape to work on"},
                     {"description",
                      "ID of an uploaded shape or a link to it. Not needed where the file itself "
                      "is the body or a part of the request."},
                     {"minOccurs", 1},
                     {"maxOccurs", 1},
                     {"schema", shape_schema()}}}};
    for (const Parameter& parameter : parameters_of(task, limits)) {
        inputs[std::string(parameter.name)] = {{"title", parameter.title},
                                               {"description", parameter.description},
                                               {"minOccurs", 0},
                                               {"maxOccurs", 1},
                                               {"schema", parameter_schema(parameter)}};
    }
    return inputs;
}

json output(std::string_view title, std::string_view description, std::string_view media_type) {
    return {{"title", title},
            {"description", description},
            {"schema", {{"type", "string"}, {"contentMediaType", media_type}}}};
}

json outputs_of(Task task) {
    json outputs = {
        {"dictionary",
         output("Dictionary", "Pattern points and atoms in units of the radius, usage, energy.",
                "application/json")},
        {"report",
         output("Report", "What was measured, chosen, done and found.", "application/json")},
        {"fields", output("Fields", "One vertex per local probing field, with frame and code.",
                          "application/ply")}};
    if (task != Task::Analyze) {
        outputs["points"] = output("Points",
                                   "The resulting points with their attributes, as PLY "
                                   "or Draco.",
                                   "application/ply");
    }
    return outputs;
}

json summary_of(Task task, std::string_view version) {
    const std::string id(process_id(task));
    const std::string path = "/v1/processes/" + id;
    const ProcessText text = text_of(task);
    return {{"id", id},
            {"title", text.title},
            {"description", text.description},
            {"version", version},
            {"jobControlOptions", {"async-execute", "sync-execute", "dismiss"}},
            {"outputTransmission", {"reference", "value"}},
            {"links",
             {to_json(Link{.href = path, .rel = "self", .title = "This process"}),
              to_json(Link{.href = path + "/execution",
                           .rel = "http://www.opengis.net/def/rel/ogc/1.0/execute",
                           .title = "Start a job: POST"})}}};
}

}  // namespace

json process_list(std::string_view version) {
    json processes = json::array();
    for (const Task task : all_tasks()) processes.push_back(summary_of(task, version));
    return {{"processes", std::move(processes)},
            {"links", json::array({to_json(Link{.href = "/v1/processes", .rel = "self"})})}};
}

json process_description(Task task, const Limits& limits, std::string_view version) {
    json description = summary_of(task, version);
    description["inputs"] = inputs_of(task, limits);
    description["outputs"] = outputs_of(task);
    return description;
}

}  // namespace lpf

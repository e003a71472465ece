#include "api/openapi/schemas.h"

#include <nlohmann/json.hpp>

#include "api/choices.h"
#include "api/job.h"
#include "api/openapi/parts.h"
#include "api/parameters.h"
#include "api/shape_info.h"

namespace lpf::openapi {
namespace {

Json links() { return array_of(component("Link")); }

Json link_schema() {
    return object("A link as OGC API writes it.", {{"href", text("Where it leads.")},
                                                   {"rel", text("What lies there.")},
                                                   {"type", text("Media type.")},
                                                   {"title", text("For a human."), false}});
}

Json problem_schema() {
    std::vector<std::string_view> codes;
    for (const ProblemKind& kind : problem_table()) codes.push_back(kind.code);
    Json schema =
        object("An error (RFC 9457). Further members may say more, such as `limit`.",
               {{"type", text("URI of the kind of problem.")},
                {"title", text("The kind of problem in words.")},
                {"status", integer("HTTP status.", 400)},
                {"detail", text("What was wrong, where, and what would be right.")},
                {"instance", text("Path that the problem is about."), false},
                {"code", one_of("Stable name of the problem.", codes)},
                {"retryAfter", integer("Seconds after which to try again."), false},
                {"errors", array_of(component("FieldError"), "Every fault found."), false}});
    schema["additionalProperties"] = true;
    return schema;
}

Json field_error_schema() {
    return object("One fault in the request.",
                  {{"pointer", text("JSON pointer to it.")}, {"detail", text("What is wrong.")}});
}

Json warning_schema() {
    return object("Something to know although the work went on.",
                  {{"code", text("Stable name.")}, {"detail", text("One sentence.")}});
}

Json parameters_schema(Task task, const Limits& limits) {
    std::vector<Field> fields;
    for (const Parameter& parameter : parameters_of(task, limits)) {
        fields.push_back({std::string(parameter.name), parameter_schema(parameter)});
    }
    return object("What was asked for; auto where nothing was.", fields);
}

Json shape_reference_schema() {
    return {{"description", "An uploaded shape: its ID or a link to it."},
            {"oneOf",
             {id(""), object("", {{"href", {{"type", "string"}, {"pattern", "^/v1/shapes/"}}}})}}};
}

Json inputs_schema(Task task, const Limits& limits) {
    std::vector<Field> fields{{"shape", component("ShapeReference")}};
    for (const Parameter& parameter : parameters_of(task, limits)) {
        fields.push_back({std::string(parameter.name), parameter_schema(parameter), false});
    }
    return object("Inputs of the process " + std::string(process_id(task)) + ".", fields);
}

Json multipart_schema(Task task, const Limits& limits) {
    std::vector<Field> fields{{"file",
                               {{"type", "string"},
                                {"contentMediaType", "application/octet-stream"},
                                {"description", "The file, PLY or Draco."}}}};
    for (const Parameter& parameter : parameters_of(task, limits)) {
        fields.push_back({std::string(parameter.name), parameter_schema(parameter), false});
    }
    return object("The file and the inputs as fields of a form.", fields);
}

Json status_schema() {
    std::vector<std::string_view> statuses;
    for (int i = 0; i < 5; ++i) statuses.push_back(status_name(static_cast<JobStatus>(i)));
    return one_of("State of a job.", statuses);
}

Json process_id_schema() {
    std::vector<std::string_view> names;
    for (const Task task : all_tasks()) names.push_back(process_id(task));
    return one_of("The process.", names);
}

Json status_info_schema() {
    const Json parameters = {{"description", "What was asked for; auto where nothing was."},
                             {"anyOf",
                              {component("DenoiseParameters"), component("ResampleParameters"),
                               component("AnalyzeParameters")}}};
    return object("A job.", {{"jobID", id("ID of the job.")},
                             {"id", id("The same.")},
                             {"processID", process_id_schema()},
                             {"type", {{"type", "string"}, {"const", "process"}}},
                             {"status", component("Status")},
                             {"message", text("One line for a human.")},
                             {"progress", {{"type", "integer"}, {"minimum", 0}, {"maximum", 100}}},
                             {"created", time("When the job was accepted.")},
                             {"started", time("When it was started last."), false},
                             {"finished", time("When it ended."), false},
                             {"updated", time("When any of this changed last.")},
                             {"expires", time("When its results are deleted."), false},
                             {"phase", text("What is being done."), false},
                             {"phaseProgress", phase_progress(), false},
                             {"etaSeconds", number("Estimate of the time that is left."), false},
                             {"queuePosition", integer("Place in the queue; 1 is next.", 1), false},
                             {"estimatedStart", time("Estimate of its start."), false},
                             {"attempt", integer("How often it was started.")},
                             {"parameters", parameters},
                             {"resolvedParameters", component("ResolvedParameters")},
                             {"shape", text("ID of the shape it works on.")},
                             {"warnings", array_of(component("Warning"))},
                             {"exception", component("Problem"), false},
                             {"retryOf", id("The job whose inputs it has."), false},
                             {"links", links()}});
}

Json resolved_schema() {
    const Json value = {{"description", "The value that is used."}, {"type", {"number", "string"}}};
    return map_of("The parameters as they are used, by name.",
                  object("", {{"value", value},
                              {"source", one_of("Who chose it.", {"auto", "request"})},
                              {"rule", text("How it was found.")}}));
}

Json bounds_schema() {
    const Json corner = {
        {"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
    return object("Axis-aligned box, in the unit of the file.", {{"min", corner}, {"max", corner}});
}

Json attribute_schema() {
    std::vector<std::string_view> types;
    for (int i = 0; i < 8; ++i) types.push_back(scalar_type_name(static_cast<ScalarType>(i)));
    return object("An attribute of the points.",
                  {{"name", text("As in the file.")},
                   {"type", one_of("Type of a value.", types)},
                   {"list", boolean("Each point has a list of values.")}});
}

Json shape_schema() {
    return object("An uploaded shape.",
                  {{"id", id("ID of the shape.")},
                   {"format", text("Format of the file, as in /v1/info.")},
                   {"bytes", integer("Size of the file.")},
                   {"sha256", {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}},
                   {"points", integer("Number of points.")},
                   {"faces", integer("Number of faces.")},
                   {"attributes", array_of(component("Attribute"))},
                   {"bounds", component("Bounds"), false},
                   {"meanSpacing", number("Mean distance of neighbouring points."), false},
                   {"created", time("When it was uploaded.")},
                   {"expires", time("When it is deleted."), false},
                   {"warnings", array_of(component("Warning"))},
                   {"links", links()}});
}

Json limits_schema() {
    std::vector<Field> fields;
    for (const LimitField& field : limit_table()) {
        Json schema = integer(field.description);
        schema["x-unit"] = field.unit;
        fields.push_back({std::string(field.name), schema});
    }
    return object("Every limit of the service.", fields);
}

Json info_schema() {
    return object(
        "The running service.",
        {{"name", text("Name of the program.")},
         {"version", text("Its version.")},
         {"limits", component("Limits")},
         {"formats", array_of(object("", {{"name", text("As in the input `format`.")},
                                          {"mediaType", text("Media type.")},
                                          {"extension", text("Ending of a file's name.")}}))},
         {"queue", object("The queue.", {{"queued", integer("Jobs that wait.")},
                                         {"running", integer("Jobs that run.")},
                                         {"capacity", integer("Jobs that may wait.")},
                                         {"workers", integer("Jobs that can run at once.")},
                                         {"threadsPerJob", integer("Threads of each.")}})},
         {"retention", object("How long things are kept.",
                              {{"resultSeconds", integer("Results, after the job ended.")},
                               {"statusSeconds", integer("Status, after the job ended.")}})},
         {"uptimeSeconds", integer("Time since the start.")},
         {"authentication", boolean("API keys are required.")}});
}

Json process_summary(bool whole) {
    const Json texts = array_of({{"type", "string"}});
    const Json value = {{"type", "object"}, {"description", "A JSON Schema (draft 2020-12)."}};
    std::vector<Field> fields{
        {"id", process_id_schema()}, {"title", text("Name.")},     {"description", text("")},
        {"version", text("")},       {"jobControlOptions", texts}, {"outputTransmission", texts},
        {"links", links()}};
    if (whole) {
        fields.push_back({"inputs", map_of("By name.", object("", {{"title", text("")},
                                                                   {"description", text("")},
                                                                   {"minOccurs", integer("")},
                                                                   {"maxOccurs", integer("")},
                                                                   {"schema", value}}))});
        fields.push_back({"outputs", map_of("By name.", object("", {{"title", text("")},
                                                                    {"description", text("")},
                                                                    {"schema", value}}))});
    }
    return object(whole ? "A process with its inputs and outputs." : "A process.", fields);
}

}  // namespace

Json service_schemas(const Limits& limits) {
    Json schemas = {
        {"Link", link_schema()},
        {"Problem", problem_schema()},
        {"FieldError", field_error_schema()},
        {"Warning", warning_schema()},
        {"Status", status_schema()},
        {"StatusInfo", status_info_schema()},
        {"ResolvedParameters", resolved_schema()},
        {"JobList", object("A page of jobs.",
                           {{"jobs", array_of(component("StatusInfo"))}, {"links", links()}})},
        {"ShapeReference", shape_reference_schema()},
        {"Shape", shape_schema()},
        {"Attribute", attribute_schema()},
        {"Bounds", bounds_schema()},
        {"LandingPage",
         object("The landing page.",
                {{"title", text("")}, {"description", text("")}, {"links", links()}})},
        {"Conformance",
         object("Conformance classes.", {{"conformsTo", array_of({{"type", "string"}})}})},
        {"Limits", limits_schema()},
        {"Info", info_schema()},
        {"ProcessSummary", process_summary(false)},
        {"Process", process_summary(true)},
        {"ProcessList",
         object("All processes.",
                {{"processes", array_of(component("ProcessSummary"))}, {"links", links()}})}};
    for (const Task task : all_tasks()) {
        std::string name(process_id(task));
        name[0] = static_cast<char>(name[0] - 'a' + 'A');
        schemas[name + "Parameters"] = parameters_schema(task, limits);
        schemas[name + "Form"] = multipart_schema(task, limits);
        schemas[name + "Request"] =
            object("Body of an execution request.", {{"inputs", inputs_schema(task, limits)}});
    }
    return schemas;
}

}  // namespace lpf::openapi

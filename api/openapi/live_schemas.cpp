#include <nlohmann/json.hpp>

#include "api/attribute_plan.h"
#include "api/choices.h"
#include "api/openapi/parts.h"
#include "api/openapi/schemas.h"
#include "api/parameters.h"

namespace lpf::openapi {
namespace {

Json share(std::string_view description) {
    Json schema = number(description);
    schema["minimum"] = 0;
    schema["maximum"] = 1;
    return schema;
}

Json progress_schema() {
    return object("How far a job has come.",
                  {{"jobID", id("ID of the job.")},
                   {"status", component("Status")},
                   {"message", text("One line for a human.")},
                   {"progress", {{"type", "integer"}, {"minimum", 0}, {"maximum", 100}}},
                   {"updated", time("When any of this changed last.")},
                   {"phase", text("What is being done."), false},
                   {"phaseProgress", phase_progress(), false},
                   {"etaSeconds", number("Estimate of the time that is left."), false},
                   {"queuePosition", integer("Place in the queue; 1 is next.", 1), false}});
}

Json log_schema() {
    return object("Something to know about a job.", {{"jobID", id("ID of the job.")},
                                                     {"time", time("When it happened.")},
                                                     {"code", text("Stable name.")},
                                                     {"detail", text("One sentence.")}});
}

Json event(const std::vector<std::string_view>& names, std::string_view data) {
    return object("", {{"id", integer("Grows from event to event.", 1)},
                       {"event", one_of("", names)},
                       {"data", component(data)}});
}

Json event_schema() {
    return {{"description", "An event, its data read as JSON."},
            {"oneOf",
             {event({"status", "end"}, "StatusInfo"), event({"progress"}, "JobProgress"),
              event({"log"}, "JobLog")}}};
}

Json shape_schema() {
    std::vector<std::string_view> formats{"ply", "drc"};
    return object("The shape that was looked at.",
                  {{"id", id("Its ID, if it is stored."), false},
                   {"format", one_of("Format of the file.", formats)},
                   {"points", integer("Number of usable points.")},
                   {"faces", integer("Number of faces.")},
                   {"examinedShare",
                    share("Share of the points that was looked at: of a large shape, a few boxes "
                          "stand for the whole.")}});
}

Json neighbours_schema() {
    const Json bin = object("", {{"from", integer("Fewest neighbours of the bin.")},
                                 {"to", integer("Most neighbours of the bin.")},
                                 {"share", share("Share of the points.")}});
    return object("How many neighbours points have within the radius, on a sample.",
                  {{"radius", number("The radius, in the unit of the file.")},
                   {"p10", integer("A tenth of the points have fewer or as many.")},
                   {"median", integer("Half of the points have fewer or as many.")},
                   {"p90", integer("Nine tenths of the points have fewer or as many.")},
                   {"histogram", array_of(bin, "In order; the bins double.")}});
}

Json plan_schema() {
    std::vector<std::string_view> fates;
    for (int i = 0; i < 5; ++i) fates.push_back(fate_name(static_cast<Fate>(i)));
    return object(
        "What becomes of an attribute.",
        {{"name", text("As in the file; `position` for x y z.")},
         {"element", text("vertex, face, or as in the file.")},
         {"plan", one_of("kept: each point keeps its own; carried: from the nearest point of the "
                         "input; computed: made anew; dropped: not in the result; unused: the "
                         "process makes no points.",
                         fates)},
         {"detail", text("Why, and how exactly.")}});
}

Json estimate_schema() {
    return object("What a job would take on this server if no other ran.",
                  {{"seconds", number("Time from its start to its end.")},
                   {"memoryBytes", integer("Most memory at a time; rather too high than too low.")},
                   {"threads", integer("Threads it would run on.", 1)},
                   {"fields", integer("Local probing fields.")},
                   {"outputPoints", integer("Points of the result."), false}});
}

Json validation_schema() {
    std::vector<std::string_view> processes;
    for (const Task task : all_tasks()) processes.push_back(process_id(task));
    const Json parameters = {{"description", "What was asked for; auto where nothing was."},
                             {"anyOf",
                              {component("DenoiseParameters"), component("ResampleParameters"),
                               component("AnalyzeParameters")}}};
    return object("What a job would do and take.",
                  {{"processID", one_of("The process.", processes)},
                   {"shape", shape_schema()},
                   {"parameters", parameters},
                   {"resolvedParameters", component("ResolvedParameters")},
                   {"measurements", component("Measurements")},
                   {"neighbours", neighbours_schema()},
                   {"attributes", array_of(component("AttributePlan"))},
                   {"estimate", estimate_schema()},
                   {"warnings", array_of(component("Warning"))}});
}

}  // namespace

Json live_schemas() {
    return {{"JobProgress", progress_schema()},
            {"JobLog", log_schema()},
            {"JobEvent", event_schema()},
            {"AttributePlan", plan_schema()},
            {"Validation", validation_schema()}};
}

}  // namespace lpf::openapi

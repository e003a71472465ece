#include <nlohmann/json.hpp>

#include "api/openapi/parts.h"
#include "api/openapi/schemas.h"
#include "api/parameters.h"
#include "api/results.h"

namespace lpf::openapi {
namespace {

Json results_schema() {
    std::vector<Field> fields;
    for (int i = 0; i < 4; ++i) {
        const auto kind = static_cast<ResultKind>(i);
        // An analysis makes no points.
        fields.push_back(
            {std::string(result_name(kind)), component("ResultFile"), kind != ResultKind::Points});
    }
    return object("What a job has left behind.", fields);
}

Json result_file_schema() {
    return object("One file of a result.",
                  {{"href", text("Where it lies.")},
                   {"type", text("Media type.")},
                   {"bytes", integer("Size.")},
                   {"sha256", {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}}});
}

Json energy_step_schema() {
    return object("Energy per field after each step of an iteration (the method's Eq. 2).",
                  {{"learning", number("After learning the dictionary.")},
                   {"pose", number("After fitting the poses.")},
                   {"probing", number("After probing anew.")}});
}

Json triples(std::string_view description) {
    const Json triple = {
        {"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
    return array_of(triple, description);
}

Json dictionary_schema(bool whole) {
    const Json pattern =
        object("Kind of the pattern.",
               {{"kind", one_of("A regular grid in a disk, or points.", {"grid", "points"})},
                {"gridSize", integer("Nodes on the diameter of a grid.", 4), false}});
    std::vector<Field> fields{
        {"id", id("ID of the dictionary."), false},
        {"radius", number("Radius it was learned at, in the unit of the file.")},
        {"lambda", number("Weight of sparsity it was learned at.")},
        {"usage", array_of({{"type", "number"}}, "Share of the fields that use each atom.")},
        {"energy", array_of({{"type", "number"}}, "Energy per field after each iteration.")},
        {"energySteps", array_of(component("EnergyStep"))},
        {"pattern", pattern},
        {"sourceJob", id("Job that learned it."), false},
        {"created", time("When it was learned.")}};
    if (whole) {
        fields.push_back({"patternPoints", triples("M points in units of the radius.")});
        fields.push_back({"atoms", array_of(triples(""), "d x M x 3, in units of the radius.")});
    } else {
        fields.push_back({"patternPoints", integer("Number M of pattern points.", 5)});
        fields.push_back({"atoms", integer("Number d of atoms.", 1)});
        fields.push_back({"links", array_of(component("Link"))});
    }
    return object(whole ? "A dictionary, all of it." : "A dictionary, described.", fields);
}

Json displacement_schema() {
    std::vector<Field> fields;
    for (const char* name : {"rms", "mean", "p50", "p90", "p99", "max"}) {
        fields.push_back({name, number("")});
    }
    return object("How far points went, in the unit of the file.", fields);
}

Json measurements_schema() {
    return object("What was measured on the input, in the unit of the file.",
                  {{"diagonal", number("Of the bounding box.")},
                   {"meanSpacing", number("Mean distance of neighbouring points.")},
                   {"noise", number("Standard deviation off the local surface, on average.")},
                   {"leastNoise", number("The same where there is least of it.")},
                   {"mostNoise", number("The same where there is most of it.")},
                   {"densityRadius", number("Radius that holds about 150 points.")}});
}

Json counted_schema(bool input) {
    std::vector<Field> fields{{"points", integer("Number of points.")},
                              {"bounds", component("Bounds"), false}};
    if (input) fields.push_back({"faces", integer("Number of faces.")});
    return object(input ? "What came in." : "What came out.", fields);
}

Json report_schema() {
    std::vector<std::string_view> processes;
    for (const Task task : all_tasks()) processes.push_back(process_id(task));
    const Json phase =
        object("", {{"phase", text("What was done.")}, {"seconds", number("How long it took.")}});
    return object(
        "What a job measured, chose, did and found.",
        {{"version", text("Version of the program.")},
         {"jobID", id("The job.")},
         {"processID", one_of("The process.", processes)},
         {"input", counted_schema(true)},
         {"output", counted_schema(false), false},
         {"measurements", component("Measurements")},
         {"resolvedParameters", component("ResolvedParameters")},
         {"fields", integer("Number of local probing fields.")},
         {"energy", array_of({{"type", "number"}}, "Energy per field after each iteration.")},
         {"energySteps", array_of(component("EnergyStep"))},
         {"rmsMoves", array_of({{"type", "number"}}, "RMS move of each outer iteration."), false},
         {"displacement", component("Displacement"), false},
         {"outliers", integer("Isolated points found.")},
         {"duplicates", integer("Points at the place of an earlier one.")},
         {"nonFinite", integer("Points dropped because a coordinate was not finite.")},
         {"phases", array_of(phase, "In the order they ran.")},
         {"seconds", number("Time of the whole job.")},
         {"threads", integer("Threads it ran on.")},
         {"peakMemoryBytes", integer("Most memory in use."), false},
         {"warnings", array_of(component("Warning"))}});
}

}  // namespace

Json result_schemas() {
    return {{"Results", results_schema()},
            {"ResultFile", result_file_schema()},
            {"EnergyStep", energy_step_schema()},
            {"Dictionary", dictionary_schema(true)},
            {"DictionarySummary", dictionary_schema(false)},
            {"DictionaryList", object("All dictionaries.",
                                      {{"dictionaries", array_of(component("DictionarySummary"))},
                                       {"links", array_of(component("Link"))}})},
            {"Displacement", displacement_schema()},
            {"Measurements", measurements_schema()},
            {"Report", report_schema()}};
}

}  // namespace lpf::openapi

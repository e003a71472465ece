#include "api/openapi.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "api/dictionary_document.h"
#include "api/parameters.h"
#include "api/processes.h"
#include "api/report.h"
#include "api/results.h"
#include "api/service_info.h"
#include "tests/api/samples.h"
#include "tests/api/schema_checker.h"

namespace lpf {
namespace {

using nlohmann::json;

const json& document() {
    static const json kDocument = openapi_document(Limits{}, "1.2.3", "http://127.0.0.1:8080");
    return kDocument;
}

/// Expects that a document which the service sends follows its schema.
void expect_valid(const json& value, const std::string& name) {
    for (const std::string& fault : test::component_faults(value, name, document())) {
        ADD_FAILURE() << name << fault;
    }
}

/// Calls `visit(path, method, operation)` for each operation.
template <typename Visit>
void for_each_operation(const Visit& visit) {
    for (const auto& [path, item] : document()["paths"].items()) {
        for (const auto& [method, operation] : item.items()) {
            if (method != "servers") visit(path, method, operation);
        }
    }
}

void collect_references(const json& value, std::set<std::string>& references) {
    for (const auto& [key, member] : value.items()) {
        if (key == "$ref" && member.is_string()) references.insert(member.get<std::string>());
        if (member.is_structured()) collect_references(member, references);
    }
}

TEST(OpenApi, HasEveryPathOfTheContract) {
    const std::string job = "/v1/jobs/{jobID}";
    const std::pair<std::string, std::set<std::string>> expected[] = {
        {"/", {"get"}},
        {"/v1", {"get"}},
        {"/v1/", {"get"}},
        {"/v1/conformance", {"get"}},
        {"/v1/openapi.json", {"get"}},
        {"/v1/info", {"get"}},
        {"/v1/processes", {"get"}},
        {"/v1/processes/{processID}", {"get"}},
        {"/v1/processes/denoise/execution", {"post"}},
        {"/v1/processes/resample/execution", {"post"}},
        {"/v1/processes/analyze/execution", {"post"}},
        {"/v1/processes/denoise/validate", {"post"}},
        {"/v1/processes/resample/validate", {"post"}},
        {"/v1/processes/analyze/validate", {"post"}},
        {"/v1/shapes", {"post"}},
        {"/v1/shapes/{shapeID}", {"get", "head", "delete"}},
        {"/v1/shapes/{shapeID}/data", {"get", "head"}},
        {"/v1/shapes/{shapeID}/preview", {"get", "head"}},
        {"/v1/jobs", {"get"}},
        {job, {"get", "delete"}},
        {job + "/events", {"get"}},
        {job + "/preview", {"get", "head"}},
        {job + "/retry", {"post"}},
        {job + "/results", {"get"}},
        {job + "/results/points", {"get", "head"}},
        {job + "/results/dictionary", {"get", "head"}},
        {job + "/results/report", {"get", "head"}},
        {job + "/results/fields", {"get", "head"}},
        {"/v1/dictionaries", {"get"}},
        {"/v1/dictionaries/{dictionaryID}", {"get"}},
        {"/v1/dictionaries/{dictionaryID}/data", {"get"}},
        {"/healthz", {"get"}},
        {"/readyz", {"get"}},
        {"/metrics", {"get"}}};
    EXPECT_EQ(document()["paths"].size(), std::size(expected));
    for (const auto& [path, methods] : expected) {
        std::set<std::string> found;
        for (const auto& [method, unused] : document()["paths"][path].items()) {
            if (method != "servers") found.insert(method);
        }
        EXPECT_EQ(found, methods) << path;
    }
}

TEST(OpenApi, OperationsHaveUniqueIdsTagsAndProblems) {
    std::set<std::string> ids;
    std::set<std::string> tags;
    for (const json& tag : document()["tags"]) tags.insert(tag["name"].get<std::string>());
    for_each_operation([&](const std::string& path, const std::string& method, const json& o) {
        EXPECT_TRUE(ids.insert(o["operationId"].get<std::string>()).second) << path << method;
        EXPECT_TRUE(tags.contains(o["tags"][0].get<std::string>())) << path;
        for (const char* status : {"400", "500", "503"}) {
            EXPECT_TRUE(o["responses"].contains(status)) << path << " " << method << " " << status;
        }
    });
}

TEST(OpenApi, EveryReferenceLeadsSomewhereAndEveryComponentIsUsed) {
    std::set<std::string> references;
    collect_references(document(), references);
    for (const std::string& reference : references) {
        EXPECT_TRUE(document().contains(json::json_pointer(reference.substr(1)))) << reference;
    }
    for (const char* section : {"schemas", "parameters", "headers"}) {
        for (const auto& [name, unused] : document()["components"][section].items()) {
            EXPECT_TRUE(references.contains("#/components/" + std::string(section) + "/" + name))
                << section << " " << name;
        }
    }
}

TEST(OpenApi, PathParametersAreDeclared) {
    for_each_operation([](const std::string& path, const std::string& method, const json& o) {
        std::set<std::string> declared;
        for (const json& reference : o.value("parameters", json::array())) {
            const std::string pointer = reference["$ref"].get<std::string>().substr(1);
            const json& parameter = document().at(json::json_pointer(pointer));
            if (parameter["in"] == "path")
                declared.insert("{" + std::string(parameter["name"]) + "}");
        }
        EXPECT_EQ(declared.size(),
                  static_cast<std::size_t>(std::count(path.begin(), path.end(), '{')))
            << path << " " << method;
        for (const std::string& name : declared) {
            EXPECT_NE(path.find(name), std::string::npos) << path;
        }
    });
}

TEST(OpenApi, ExecutionTakesEveryInputOfItsProcess) {
    for (const Task task : all_tasks()) {
        const std::string path = "/v1/processes/" + std::string(process_id(task)) + "/execution";
        const json& operation = document()["paths"][path]["post"];
        std::set<std::string> references;
        collect_references(operation["parameters"], references);
        for (const Parameter& parameter : parameters_of(task, Limits{})) {
            EXPECT_TRUE(
                references.contains("#/components/parameters/" + std::string(parameter.name)))
                << path << " " << parameter.name;
        }
        for (const char* status :
             {"200", "201", "400", "411", "413", "415", "422", "429", "503", "507"}) {
            EXPECT_TRUE(operation["responses"].contains(status)) << path << " " << status;
        }
    }
}

TEST(OpenApi, ServerAddressEndsInNoSlashUnlessItIsTheRoot) {
    EXPECT_EQ(openapi_document(Limits{}, "1", "/")["servers"][0]["url"], "/");
    EXPECT_EQ(openapi_document(Limits{}, "1", "https://h/")["servers"][0]["url"], "https://h");
}

TEST(OpenApi, ServerAndVersionAreThoseGiven) {
    EXPECT_EQ(document()["openapi"], "3.1.0");
    EXPECT_EQ(document()["info"]["version"], "1.2.3");
    EXPECT_EQ(document()["servers"], (json::array({{{"url", "http://127.0.0.1:8080"}}})));
}

TEST(OpenApi, JobsFollowTheirSchema) {
    for (const Task task : all_tasks()) {
        StatusInfo info = test::full_status();
        info.process = task;
        expect_valid(to_json(info), "StatusInfo");
        StatusInfo bare;
        bare.process = task;
        bare.job_id = test::kJobId;
        expect_valid(to_json(bare), "StatusInfo");
    }
    expect_valid(job_list_to_json({test::full_status()}, "limit=1", "x"), "JobList");
}

TEST(OpenApi, EveryProblemFollowsItsSchema) {
    for (const ProblemKind& kind : problem_table()) {
        expect_valid(to_json(Problem{.problem = kind.problem,
                                     .detail = "x",
                                     .instance = "/v1",
                                     .errors = {{"/inputs/radius", "y"}},
                                     .retry_after = 1,
                                     .members = {{"limit", std::int64_t{3}}}}),
                     "Problem");
    }
}

TEST(OpenApi, ServiceDocumentsFollowTheirSchemas) {
    expect_valid(landing_page(), "LandingPage");
    expect_valid(conformance(), "Conformance");
    expect_valid(service_info({.version = "1"}, Limits{}), "Info");
    expect_valid(process_list("1"), "ProcessList");
    for (const Task task : all_tasks()) {
        expect_valid(process_description(task, Limits{}, "1"), "Process");
    }
}

TEST(OpenApi, ShapesFollowTheirSchema) {
    expect_valid(to_json(test::full_shape()), "Shape");
    ShapeInfo bare = test::full_shape();
    bare.bounds.reset();
    bare.mean_spacing.reset();
    bare.expires.reset();
    expect_valid(to_json(bare), "Shape");
}

TEST(OpenApi, ResultsFollowTheirSchemas) {
    std::vector<ResultFile> files;
    for (const auto kind :
         {ResultKind::Points, ResultKind::Dictionary, ResultKind::Report, ResultKind::Fields}) {
        files.push_back({kind, "application/ply", 1, test::kSha});
    }
    expect_valid(results_to_json(test::kJobId, files), "Results");
    files.erase(files.begin());
    expect_valid(results_to_json(test::kJobId, files), "Results");
    const DictionaryDocument dictionary = make_dictionary_document(
        test::small_analysis(), test::kDictionaryId, test::kJobId, test::kTime);
    expect_valid(to_json(dictionary), "Dictionary");
    expect_valid(summary_to_json(dictionary), "DictionarySummary");
    expect_valid(dictionary_list_to_json({summary_to_json(dictionary)}), "DictionaryList");
    for (const Task task : all_tasks()) expect_valid(to_json(test::full_report(task)), "Report");
}

TEST(OpenApi, SchemasRefuseWhatIsNotTheirs) {
    json job = to_json(test::full_status());
    job["surprise"] = 1;
    EXPECT_EQ(test::component_faults(job, "StatusInfo", document()).size(), 1U);
    job = to_json(test::full_status());
    job.erase("progress");
    EXPECT_EQ(test::component_faults(job, "StatusInfo", document()).size(), 1U);
    job = to_json(test::full_status());
    job["status"] = "finished";
    EXPECT_EQ(test::component_faults(job, "StatusInfo", document()).size(), 1U);
    const json denoise_with_factor = {{"inputs", {{"shape", test::kShapeId}, {"factor", 4}}}};
    EXPECT_FALSE(test::component_faults(denoise_with_factor, "DenoiseRequest", document()).empty());
    EXPECT_TRUE(test::component_faults(denoise_with_factor, "ResampleRequest", document()).empty());
}

TEST(OpenApi, ExamplesFollowTheirSchemas) {
    int examples = 0;
    for_each_operation([&](const std::string& path, const std::string&, const json& operation) {
        json contents = json::array();
        for (const auto& [status, response] : operation["responses"].items()) {
            contents.push_back(response.value("content", json::object()));
        }
        if (operation.contains("requestBody"))
            contents.push_back(operation["requestBody"]["content"]);
        for (const json& content : contents) {
            for (const auto& [type, media] : content.items()) {
                if (!media.contains("example")) continue;
                ++examples;
                const auto faults =
                    test::schema_faults(media["example"], media["schema"], document());
                EXPECT_TRUE(faults.empty()) << path << " " << type << faults.front();
            }
        }
    });
    EXPECT_GT(examples, 50);
}

TEST(Processes, DescribeEveryInputAndOutput) {
    const json denoise = process_description(Task::Denoise, Limits{}, "1");
    EXPECT_EQ(denoise["jobControlOptions"], (json{"async-execute", "sync-execute", "dismiss"}));
    EXPECT_EQ(denoise["inputs"]["shape"]["minOccurs"], 1);
    EXPECT_EQ(denoise["inputs"]["radius"]["minOccurs"], 0);
    EXPECT_EQ(denoise["inputs"]["radius"]["schema"]["default"], "auto");
    EXPECT_TRUE(denoise["outputs"].contains("points"));
    EXPECT_FALSE(process_description(Task::Analyze, Limits{}, "1")["outputs"].contains("points"));
}

TEST(ServiceInfo, ShowsLimitsFormatsQueueAndRetention) {
    const json info = service_info({.version = "9", .queued = 3, .running = 1, .workers = 2},
                                   Limits{.queued_jobs = 7});
    EXPECT_EQ(info["version"], "9");
    EXPECT_EQ(info["limits"]["queuedJobs"], 7);
    EXPECT_EQ(info["queue"]["queued"], 3);
    EXPECT_EQ(info["queue"]["capacity"], 7);
    EXPECT_EQ(info["retention"]["resultSeconds"], 7 * 24 * 3600);
    std::set<std::string> formats;
    for (const json& format : info["formats"]) formats.insert(format["name"].get<std::string>());
    EXPECT_TRUE(formats.contains("ply") && formats.contains("drc"));
}

}  // namespace
}  // namespace lpf

// Any bytes as a JSON body: an execution request, a dictionary, or the same inputs as a query
// string. What is accepted keeps to the limits and survives being stored.

#include <map>
#include <nlohmann/json.hpp>

#include "api/dictionary_document.h"
#include "api/job_inputs.h"
#include "api/json_text.h"
#include "api/problem.h"
#include "server/http/head.h"
#include "tests/fuzz/target.h"

namespace lpf::fuzz {
namespace {

constexpr Task kTasks[] = {Task::Denoise, Task::Resample, Task::Analyze};

void require_storable(Task task, const JobInputs& inputs) {
    const auto stored = nlohmann::json::parse(dump_json(to_json(task, inputs)));
    require(stored_inputs_from_json(stored) == inputs, "inputs come back as they were stored");
}

void try_requests(const nlohmann::json& body, const Limits& limits) {
    for (const Task task : kTasks) {
        try {
            require_storable(task, execute_request_from_json(task, body, limits).inputs);
        } catch (const ProblemException& refused) {
            require(!refused.problem().errors.empty() || !refused.problem().detail.empty(),
                    "a refusal says why");
            (void)dump_json(to_json(refused.problem()));
        }
    }
}

void try_dictionary(const nlohmann::json& body, const Limits& limits) {
    try {
        const DictionaryDocument document = dictionary_from_json(body, limits);
        const nlohmann::json written = to_json(document);
        const DictionaryDocument again = dictionary_from_json(written, limits);
        require(to_json(again) == written, "a dictionary comes back as it was written");
    } catch (const Error& error) {
        require(error.code() == ErrorCode::MalformedFile ||
                    error.code() == ErrorCode::IncompatibleDictionary ||
                    error.code() == ErrorCode::LimitExceeded,
                "a dictionary is refused for what it is");
    }
}

void try_json(std::string_view text) {
    Limits limits;
    limits.json_bytes = 1 << 16;
    limits.json_string_bytes = 4096;
    try {
        const nlohmann::json body = parse_json(text, limits);
        (void)dump_json(body);
        try_requests(body, limits);
        try_dictionary(body, limits);
    } catch (const ProblemException& refused) {
        (void)dump_json(to_json(refused.problem()));
    }
}

void try_query(std::string_view text) {
    try {
        std::multimap<std::string, std::string> query;
        for (auto& [name, value] : http::parse_query(text)) query.emplace(name, value);
        for (const Task task : kTasks) {
            try {
                require_storable(task, inputs_from_query(task, query, {}));
            } catch (const ProblemException& refused) {
                (void)dump_json(to_json(refused.problem()));
            }
        }
    } catch (const ProblemException&) {  // a broken %-escape
    }
}

}  // namespace

std::vector<std::string> seeds() {
    const std::string id = "0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3";
    return {R"({"inputs":{"shape":")" + id + R"("}})",
            R"({"inputs":{"shape":{"href":"/v1/shapes/)" + id +
                R"("},"radius":0.5,"radiusUnit":"spacing","atoms":16,"lambda":"auto"}})",
            R"({"inputs":{"shape":")" + id +
                R"(","targetPoints":1000,"outliers":"remove","duplicates":"keep","normals":)"
                R"("estimate","format":"drc","quantizationBits":14,"maxSeconds":10.5}})",
            R"({"inputs":{"shape":")" + id + R"(","dictionary":")" + id +
                R"(","dictionaryMode":"fixed","gamma":5e-1,"probing":"noiseAware",)"
                R"("randomSeed":9007199254740991,"\ud83d\ude00":[[[]]]}})",
            R"({"patternPoints":[[0,0,0],[0.5,0,0],[0,0.5,0],[-0.5,0,0],[0,-0.5,0]],"atoms":)"
            R"([[[0,0,0.1],[0,0,0.1],[0,0,0.1],[0,0,0.1],[0,0,0.1]]],"radius":1,"lambda":0.2})",
            R"({"id":"","patternPoints":[[0,0,0]],"atoms":[[[0.1,0,1]]],"usage":[1],"energy":[]})",
            "\xef\xbb\xbf[1e400,-0,null,true,\"\\u0000\"]",
            "radius=0.5&radiusUnit=diagonal&atoms=16&format=ply-ascii&maxSeconds=60",
            "targetSpacing=.01&normals=drop&attributes=keep&outliers=mark&randomSeed=%31"};
}

}  // namespace lpf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = lpf::fuzz::text_of(data, size);
    lpf::fuzz::try_json(text);
    lpf::fuzz::try_query(text);
    return 0;
}

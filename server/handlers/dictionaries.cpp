#include <nlohmann/json.hpp>

#include "api/dictionary_document.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/lookup.h"

namespace lpf::server {
namespace {

constexpr std::uint64_t kDefaultPage = 20;

nlohmann::json summary_of(const StoredDictionary& dictionary) {
    return nlohmann::json::parse(dictionary.summary);
}

std::string atoms_of(Services& services, const StoredDictionary& stored) {
    return atoms_to_npy(load_dictionary(services, stored.id));
}

}  // namespace

http::Response list_dictionaries(Services& services, http::Request& request) {
    allow_query(request, {"limit", "cursor"});
    const auto limit = query_number(request, "limit", services.limits().page_items, kDefaultPage);
    const DictionaryPage page = services.storage.jobs().list_dictionaries(
        limit, request.query_value("cursor").value_or(""));
    std::vector<nlohmann::json> summaries;
    for (const StoredDictionary& dictionary : page.dictionaries)
        summaries.push_back(summary_of(dictionary));
    nlohmann::json answer = dictionary_list_to_json(summaries);
    if (!page.next_cursor.empty()) {
        answer["links"].push_back({{"href", "/v1/dictionaries?limit=" + std::to_string(limit) +
                                                "&cursor=" + page.next_cursor},
                                   {"rel", "next"},
                                   {"type", "application/json"}});
    }
    return json_response(answer);
}

http::Response get_dictionary(Services& services, http::Request& request) {
    allow_query(request, {});
    return json_response(summary_of(require_dictionary(services, request.path_parameters.at(0))));
}

http::Response get_dictionary_data(Services& services, http::Request& request) {
    allow_query(request, {"format"});
    const StoredDictionary stored = require_dictionary(services, request.path_parameters.at(0));
    const std::string format = request.query_value("format").value_or("json");
    const std::string name = "dictionary-" + stored.id;
    if (format == "json") {
        return send_blob(
            request, services.storage.blobs(),
            {.type = "application/json", .filename = name + ".json", .sha256 = stored.sha256});
    }
    if (format != "npy") throw query_problem("format", "It is one of json npy.");
    return send_bytes(
        request, atoms_of(services, stored),
        {.type = "application/octet-stream", .filename = name + ".npy", .sha256 = {}});
}

}  // namespace lpf::server

#include "api/processes.h"

#include <nlohmann/json.hpp>

#include "api/parameters.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/lookup.h"

namespace lpf::server {

http::Response list_processes(Services&, http::Request&) {
    return json_response(process_list(version()));
}

http::Response get_process(Services& services, http::Request& request) {
    const Task task = require_process(request.path_parameters.at(0));
    return json_response(process_description(task, services.limits(), version()));
}

}  // namespace lpf::server

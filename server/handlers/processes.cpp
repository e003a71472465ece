#include "api/processes.h"

#include <nlohmann/json.hpp>

#include "api/parameters.h"
#include "server/answer.h"
#include "server/handlers/handlers.h"

namespace lpf::server {

http::Response list_processes(Services&, http::Request&) {
    return json_response(process_list(version()));
}

http::Response get_process(Services& services, http::Request& request) {
    const auto task = task_from_id(request.path_parameters.at(0));
    if (!task) {
        throw ProblemException(ProblemCode::ProcessNotFound,
                               "There is no process of this name; see /v1/processes.");
    }
    return json_response(process_description(*task, services.limits(), version()));
}

}  // namespace lpf::server

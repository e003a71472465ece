#pragma once

#include "server/http/message.h"
#include "server/services.h"

/// The handlers of the route table: each reads a request, asks the services, and writes the answer.
namespace lpf::server {

// service.cpp
http::Response get_landing_page(Services&, http::Request&);
http::Response get_conformance(Services&, http::Request&);
http::Response get_openapi(Services&, http::Request&);
http::Response get_info(Services&, http::Request&);
http::Response get_health(Services&, http::Request&);

// processes.cpp
http::Response list_processes(Services&, http::Request&);
http::Response get_process(Services&, http::Request&);

// execution.cpp
http::Response execute_process(Services&, http::Request&);

// validate.cpp
http::Response validate_process(Services&, http::Request&);

// shapes.cpp
http::Response upload_shape(Services&, http::Request&);
http::Response get_shape(Services&, http::Request&);
http::Response get_shape_data(Services&, http::Request&);
http::Response delete_shape(Services&, http::Request&);

// jobs.cpp
http::Response list_jobs(Services&, http::Request&);
http::Response get_job(Services&, http::Request&);
http::Response dismiss_job(Services&, http::Request&);

// events.cpp
http::Response get_events(Services&, http::Request&);

// preview.cpp
http::Response get_job_preview(Services&, http::Request&);
http::Response get_shape_preview(Services&, http::Request&);

// retry.cpp
http::Response retry_job(Services&, http::Request&);

// results.cpp
http::Response list_results(Services&, http::Request&);
http::Response get_points(Services&, http::Request&);
http::Response get_dictionary_result(Services&, http::Request&);
http::Response get_report(Services&, http::Request&);
http::Response get_fields(Services&, http::Request&);

// dictionaries.cpp
http::Response list_dictionaries(Services&, http::Request&);
http::Response get_dictionary(Services&, http::Request&);
http::Response get_dictionary_data(Services&, http::Request&);

// admin.cpp
http::Response get_readiness(Services&, http::Request&);
http::Response get_metrics(Services&, http::Request&);

// web.cpp: the page at / and its files
http::Response get_web_file(Services&, http::Request&);

}  // namespace lpf::server

#include <nlohmann/json.hpp>

#include "api/codec/format.h"
#include "api/http_text.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/ingest.h"
#include "server/requests/lookup.h"

namespace lpf::server {

http::Response upload_shape(Services& services, http::Request& request) {
    allow_query(request, {});
    const std::string type = bare_media_type(request.header("content-type").value_or(""));
    Upload upload = type == "multipart/form-data" ? receive_form(services, request)
                                                  : receive_file(services, request);
    if (!upload.fields.empty()) {
        throw ProblemException(ProblemCode::MalformedRequest,
                               "An upload has only the part 'file'; inputs belong to a job.");
    }
    const StoredShape shape = store_shape(services, std::move(upload));
    services.log.info("shape-stored", {{"shape", shape.info.id}, {"request", request.id}});
    http::Response response = json_response(to_json(shape.info), shape.known ? 200 : 201);
    return response.set("Location", "/v1/shapes/" + shape.info.id);
}

http::Response get_shape(Services& services, http::Request& request) {
    allow_query(request, {});
    return json_response(to_json(require_shape(services, request.path_parameters.at(0))));
}

http::Response get_shape_data(Services& services, http::Request& request) {
    allow_query(request, {});
    const ShapeInfo shape = require_shape(services, request.path_parameters.at(0));
    const FileFormat format = shape.format == "drc" ? FileFormat::Draco : FileFormat::PlyBinary;
    return send_blob(request, services.storage.blobs(),
                     {.type = std::string(media_type(format)),
                      .filename = "shape-" + shape.id + "." + shape.format,
                      .sha256 = shape.sha256});
}

http::Response delete_shape(Services& services, http::Request& request) {
    allow_query(request, {});
    const ShapeInfo shape = require_shape(services, request.path_parameters.at(0));
    services.storage.jobs().remove_shape(shape.id);
    services.storage.forget({shape.sha256});
    http::Response response;
    response.status = 204;
    return response;
}

}  // namespace lpf::server

#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "api/shape_info.h"
#include "server/blob_store.h"
#include "server/http/message.h"
#include "server/services.h"

namespace lpf::server {

/// What a body brought: a file on the disk, not yet kept, and the text fields of a form.
struct Upload {
    std::unique_ptr<BlobWriter> file;
    std::multimap<std::string, std::string> fields;
};

/// Streams a raw body to the disk. @throws ProblemException{PayloadTooLarge, MalformedRequest, ...}
[[nodiscard]] Upload receive_file(Services& services, const http::Request& request);

/// Streams a multipart/form-data body: one part `file`, the others short text fields.
/// @throws ProblemException{PayloadTooLarge, MalformedRequest, ...}
[[nodiscard]] Upload receive_form(Services& services, const http::Request& request);

/// Reads a short body into memory. @throws ProblemException{PayloadTooLarge, MalformedRequest}
[[nodiscard]] std::string receive_text(Services& services, const http::Request& request);

/// A shape that is in the books now.
struct StoredShape {
    ShapeInfo info;
    bool known = false;  ///< the same bytes had been uploaded before
};

/// Decodes a file to see that it can be, and keeps it as a shape.
/// @throws Error{MalformedFile, UnsupportedFormat, LimitExceeded}
[[nodiscard]] StoredShape store_shape(Services& services, Upload upload);

/// @throws ProblemException{TooFewPoints, DegenerateShape} for a shape on which no job can succeed
void require_workable(const ShapeInfo& shape);

}  // namespace lpf::server

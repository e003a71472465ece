#include "server/requests/ingest.h"

#include "api/codec/summary.h"
#include "api/http_text.h"
#include "api/memory_need.h"
#include "api/problem.h"
#include "core/base/error.h"
#include "core/shape/noise.h"
#include "server/ids.h"
#include "server/shapes/streaming.h"
#include "server/store/mapped_file.h"

namespace lpf::server {
namespace {

constexpr std::size_t kMaxFields = 64;            // more than there are inputs
constexpr std::size_t kMeasuredPoints = 500'000;  // larger shapes are measured by their job
constexpr std::uint64_t kLeastPoints = 3;

/// Counts bytes against a limit, because a chunked or compressed body declares none.
class ByteCounter {
public:
    ByteCounter(std::uint64_t limit, std::string name) : limit_(limit), name_(std::move(name)) {}

    bool add(std::size_t bytes) {
        total_ += bytes;
        return total_ <= limit_;
    }
    [[nodiscard]] std::uint64_t total() const { return total_; }

    void throw_if_exceeded() const {
        if (total_ <= limit_) return;
        throw ProblemException(ProblemCode::PayloadTooLarge,
                               "The body is larger than the limit of " + std::to_string(limit_) +
                                   " bytes (" + name_ + ").");
    }

private:
    std::uint64_t limit_;
    std::string name_;
    std::uint64_t total_ = 0;
};

void require_complete(bool complete) {
    if (complete) return;
    throw ProblemException(ProblemCode::MalformedRequest,
                           "The body ended early, or its framing or compression is broken.");
}

void require_space(Services& services, std::uint64_t bytes) {
    services.data.require_space(bytes, services.limits());
    const std::uint64_t quota = services.limits().stored_bytes;
    const std::uint64_t stored = services.storage.blobs().stored_bytes();
    if (quota == 0 || (stored <= quota && bytes <= quota - stored)) return;
    throw ProblemException(ProblemCode::InsufficientStorage,
                           "The files stored here would be more than " + std::to_string(quota) +
                               " bytes in all (storedBytes; " + std::to_string(stored) +
                               " are stored now). Delete shapes and jobs that are no longer "
                               "needed, or wait until some expire.");
}

void require_space(Services& services, const http::Request& request) {
    const auto length = parse_number(request.header("content-length").value_or("0"));
    require_space(services, length.value_or(0));
}

/// Sorts the parts of a form as they come.
class FormReader {
public:
    FormReader(Services& services, Upload& upload)
        : services_(services),
          upload_(upload),
          bytes_(services.limits().upload_bytes, "uploadBytes") {}

    bool begin(const http::Part& part) {
        in_file_ = part.name == "file";
        if (part.name.empty()) {
            mistake_ =
                "A part of the form has no name. Write the header as "
                "Content-Disposition: form-data; name=\"file\"; filename=\"...\".";
        } else if (in_file_ && upload_.file) {
            mistake_ = "The form has two parts named 'file'; a job works on one shape.";
        } else if (!in_file_ && upload_.fields.size() == kMaxFields) {
            mistake_ = "The form has too many fields.";
        }
        if (!mistake_.empty()) return false;
        if (in_file_) {
            upload_.file = services_.storage.blobs().create();
        } else {
            field_ = upload_.fields.emplace(part.name, "");
        }
        return true;
    }

    bool data(std::string_view bytes) {
        if (!bytes_.add(bytes.size())) return false;
        if (in_file_) {
            upload_.file->write(bytes);
            return true;
        }
        if (field_->second.size() + bytes.size() > services_.limits().json_string_bytes) {
            mistake_ = "A field of the form is too long for an input.";
            return false;
        }
        field_->second += bytes;
        return true;
    }

    void finish(bool complete) const {
        services_.telemetry.count_received(bytes_.total());
        bytes_.throw_if_exceeded();
        if (!mistake_.empty()) throw ProblemException(ProblemCode::MalformedRequest, mistake_);
        require_complete(complete);
        if (!upload_.file) {
            throw ProblemException(ProblemCode::MalformedRequest,
                                   "The form has no part named 'file' with the shape in it.");
        }
    }

private:
    Services& services_;
    Upload& upload_;
    ByteCounter bytes_;
    bool in_file_ = false;
    std::multimap<std::string, std::string>::iterator field_;
    std::string mistake_;
};

std::optional<double> measured_spacing(const FileSummary& summary) {
    if (!summary.sample_is_whole()) return std::nullopt;
    try {
        return measure(summary.sample, {}).mean_spacing;
    } catch (const Error&) {  // too few points, or all in one place: there is no spacing
        return std::nullopt;
    }
}

/// What the file holds, in little memory; throws if it cannot be read.
ShapeInfo inspect(Services& services, BlobWriter& file) {
    const MappedFile content(file.staged());
    const DecodingRoom::Seat seat(services.decoding,
                                  summary_bytes(content.bytes(), services.limits()));
    FileSummary summary = summarize(
        content.bytes(), decode_limits(services.limits()),
        {.most_sampled = kMeasuredPoints, .passed = [&](std::size_t n) { content.let_go(n); }});
    ShapeInfo info;
    info.format = file_extension(summary.format);
    info.bytes = file.size();
    info.points = summary.points;
    info.faces = summary.faces;
    info.warnings = summary.warnings;
    if (info.points > 0) {
        info.bounds = Bounds{summary.minimum, summary.maximum};
        info.mean_spacing = measured_spacing(summary);
    }
    info.attributes = attribute_infos({.points = {}, .attributes = std::move(summary.columns)});
    return info;
}

}  // namespace

Upload receive_file(Services& services, const http::Request& request) {
    require_space(services, request);
    Upload upload;
    upload.file = services.storage.blobs().create();
    ByteCounter bytes(services.limits().upload_bytes, "uploadBytes");
    const bool complete = request.read_body([&](std::string_view piece) {
        if (!bytes.add(piece.size())) return false;
        upload.file->write(piece);
        return true;
    });
    services.telemetry.count_received(bytes.total());
    bytes.throw_if_exceeded();
    require_complete(complete);
    return upload;
}

Upload receive_form(Services& services, const http::Request& request) {
    require_space(services, request);
    Upload upload;
    FormReader reader(services, upload);
    const bool complete =
        request.read_multipart([&](const http::Part& part) { return reader.begin(part); },
                               [&](std::string_view bytes) { return reader.data(bytes); });
    reader.finish(complete);
    return upload;
}

std::string receive_text(Services& services, const http::Request& request) {
    ByteCounter bytes(services.limits().json_bytes, "jsonBytes");
    std::string text;
    const bool complete = request.read_body([&](std::string_view piece) {
        if (!bytes.add(piece.size())) return false;
        text += piece;
        return true;
    });
    services.telemetry.count_received(bytes.total());
    bytes.throw_if_exceeded();
    require_complete(complete);
    return text;
}

StoredShape store_shape(Services& services, Upload upload) {
    const UnixMillis now = now_millis();
    const UnixMillis expires = now + services.result_retention();
    const std::string digest = upload.file->digest();
    JobStore& books = services.storage.jobs();
    const auto known = books.find_shape_by_digest(digest);
    if (known && services.storage.blobs().size(digest)) {
        if (auto kept = books.keep_shape_until(known->id, expires)) return {*kept, true};
    }
    ShapeInfo info = inspect(services, *upload.file);
    info.id = new_id();
    info.sha256 = digest;
    info.created = now;
    info.expires = expires;
    require_space(services, info.bytes);
    FileHold held(services.storage);
    held.commit(*upload.file);
    const ShapeInfo stored = books.add_shape(info);
    return {stored, stored.id != info.id};
}

void require_workable(const ShapeInfo& shape) {
    if (shape.points < kLeastPoints) {
        throw ProblemException(ProblemCode::TooFewPoints,
                               "The shape has " + std::to_string(shape.points) +
                                   " usable points; at least " + std::to_string(kLeastPoints) +
                                   " are needed.");
    }
    if (shape.bounds && shape.bounds->minimum == shape.bounds->maximum) {
        throw ProblemException(ProblemCode::DegenerateShape,
                               "All points of the shape lie in one place.");
    }
}

}  // namespace lpf::server

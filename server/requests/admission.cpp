#include "server/requests/admission.h"

#include <algorithm>

#include "api/memory_need.h"
#include "server/requests/outlook.h"
#include "server/shapes/streaming.h"

namespace lpf::server {
namespace {

double look_at_shape(Services& services, const http::Request& request, const StatusInfo& job,
                     const MappedFile& file) {
    const Question question{job.process, job.parameters, file.bytes().size()};
    const DecodingRoom::Seat seat(services.decoding,
                                  subject_bytes(question, file, services.limits()));
    const Patience patience(request);
    const Subject subject = read_subject(question, file, services.limits(), {});
    return look_ahead(services, question, subject, patience).estimate.memory_bytes;
}

}  // namespace

std::uint64_t memory_for_job(Services& services, const http::Request& request,
                             const StatusInfo& job, const ShapeInfo& shape) {
    const std::uint64_t budget = services.limits().memory_bytes;
    if (budget == 0) return 0;
    const MappedFile file(services.storage.blobs().local_file(shape.sha256));
    const bool streamed =
        streamed_points(job.process, job.parameters, file, services.limits()).has_value();
    const MemoryRange range =
        memory_range(job.process, job.parameters, shape, streamed ? services.config.threads : 0);
    require_memory(range.least, budget);
    // A job that is held for larger than it is only matters where it keeps others waiting.
    const double share = static_cast<double>(budget) / std::max(1, services.queue.workers());
    const double bytes = range.most && *range.most <= share
                             ? *range.most
                             : look_at_shape(services, request, job, file);
    require_memory(bytes, budget);
    return static_cast<std::uint64_t>(bytes);
}

}  // namespace lpf::server

#include "server/admission.h"

#include <algorithm>

#include "api/memory_need.h"
#include "server/mapped_file.h"
#include "server/outlook.h"
#include "server/runner.h"

namespace lpf::server {
namespace {

double look_at_shape(Services& services, const http::Request& request, const StatusInfo& job,
                     const ShapeInfo& shape) {
    const MappedFile file(services.storage.blobs().local_file(shape.sha256));
    const DecodingRoom::Seat seat(services.decoding,
                                  decoding_bytes(file.bytes(), services.limits()));
    const Patience patience(request);
    const Document document = decode(file.bytes(), decode_limits(services.limits()));
    const Question question{job.process, job.parameters, file.bytes().size()};
    return look_ahead(services, question, document, patience).estimate.memory_bytes;
}

}  // namespace

std::uint64_t memory_for_job(Services& services, const http::Request& request,
                             const StatusInfo& job, const ShapeInfo& shape) {
    const std::uint64_t budget = services.limits().memory_bytes;
    if (budget == 0) return 0;
    const MemoryRange range = memory_range(job.process, job.parameters, shape);
    require_memory(range.least, budget);
    // A job that is held for larger than it is only matters where it keeps others waiting.
    const double share = static_cast<double>(budget) / std::max(1, services.queue.workers());
    const double bytes = range.most && *range.most <= share
                             ? *range.most
                             : look_at_shape(services, request, job, shape);
    require_memory(bytes, budget);
    return static_cast<std::uint64_t>(bytes);
}

}  // namespace lpf::server

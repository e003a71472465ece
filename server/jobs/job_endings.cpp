#include "server/jobs/job_endings.h"

#include <new>
#include <utility>

#include "core/base/error.h"

namespace lpf::server {
namespace {

void end(StatusInfo& info, UnixMillis now, UnixMillis retention) {
    info.finished = now;
    info.updated = now;
    info.expires = now + retention;
    info.eta_seconds.reset();
}

}  // namespace

Problem problem_of(const std::exception_ptr& exception) {
    try {
        std::rethrow_exception(exception);
    } catch (const ProblemException& error) {
        return error.problem();
    } catch (const Error& error) {
        return problem_from(error);
    } catch (const std::bad_alloc&) {
        return problem_from(Error(ErrorCode::OutOfMemory,
                                  "The job needs more memory than the server has. Ask for fewer "
                                  "points, or remove points from the shape."));
    } catch (...) {
        return problem_from(Error(ErrorCode::Internal, "The job failed."));
    }
}

std::string what_of(const std::exception_ptr& exception) {
    try {
        std::rethrow_exception(exception);
    } catch (const std::exception& error) {
        return error.what();
    } catch (...) {
        return "an exception of unknown type";
    }
}

Problem out_of_time() {
    return problem_from(Error(ErrorCode::TimedOut,
                              "The job ran longer than it was allowed to (maxSeconds). Allow more, "
                              "or ask for less: a larger spacing, fewer iterations."));
}

StatusInfo succeeded(StatusInfo info, UnixMillis now, UnixMillis retention) {
    end(info, now, retention);
    info.status = JobStatus::Successful;
    info.message = "Done.";
    info.progress = 100;
    info.phase = "done";
    info.phase_progress.reset();
    return info;
}

StatusInfo failed(StatusInfo info, Problem problem, UnixMillis now, UnixMillis retention) {
    end(info, now, retention);
    info.status = JobStatus::Failed;
    info.message = problem.detail;
    info.exception = std::move(problem);
    info.exception->instance = "/v1/jobs/" + info.job_id;
    return info;
}

}  // namespace lpf::server

#pragma once

#include "api/estimate.h"
#include "server/http/message.h"
#include "server/services.h"
#include "server/shapes/subject.h"

namespace lpf::server {

/// Ends work within a request when nobody waits for its outcome any more, or it takes too long.
class Patience {
public:
    explicit Patience(const http::Request& request);

    [[nodiscard]] Execution execution() const { return {.threads = 1, .stop = stop_.get_token()}; }

private:
    std::stop_source stop_;
    std::jthread thread_;  // last: it uses the source, and is joined first
};

/// What is foreseen of a job by a look at its shape, or at parts of a large one.
struct Outlook {
    double examined_share = 1;  ///< of the points
    Measurements measurements;
    ResolvedParameters parameters;
    Findings found;
    Workload work;
    Estimate estimate;
};

/// @throws ProblemException{TimedOut} when patience has come to its end, {DictionaryNotFound};
/// Error{InvalidParameter, ...} as the job would
[[nodiscard]] Outlook look_ahead(Services& services, const Question& question,
                                 const Subject& subject, const Patience& patience);

}  // namespace lpf::server

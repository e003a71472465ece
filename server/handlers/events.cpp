// GET /v1/jobs/{id}/events: the story of a job as it goes on, for EventSource and curl.
#include <optional>

#include "api/http_text.h"
#include "api/job_event.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/lookup.h"

namespace lpf::server {
namespace {

constexpr auto kLookAgain = std::chrono::seconds(5);   // in the books, when nothing is told
constexpr const char* kRetryHint = "retry: 2000\n\n";  // milliseconds until a client comes back

/// Follows one job for one client. Asks the events, which cost next to nothing; the books only at
/// the start and when nothing has happened for a while.
class StoryFeed : public http::Feed {
public:
    StoryFeed(Services& services, const StatusInfo& job, std::uint64_t last)
        : services_(services), job_id_(job.job_id), last_(last), text_(kRetryHint) {
        if (!services_.events.knows(job_id_)) append(services_.events.tell(job));
    }

    std::string next() override {
        append(services_.events.after(job_id_, last_));
        const auto now = Clock::now();
        if (text_.empty() && now - checked_ > kLookAgain) look_into_the_books();
        if (!text_.empty()) checked_ = now;
        return std::exchange(text_, {});
    }

    [[nodiscard]] bool ended() const override { return ended_ || !services_.queue.accepting(); }

private:
    void append(const std::vector<JobEvent>& events) {
        for (const JobEvent& event : events) {
            text_ += event_text(event.id, event.name, event.data);
            last_ = event.id;
            ended_ = ended_ || event.name == "end";
        }
    }

    /// An end that was told to nobody, such as one that came about on another machine.
    void look_into_the_books() {
        checked_ = Clock::now();
        const auto job = services_.queue.find(job_id_);
        if (!job || is_finished(job->info.status)) {
            if (job) append(services_.events.tell(job->info));
            ended_ = true;
        }
    }

    Services& services_;
    std::string job_id_;
    std::uint64_t last_;
    std::string text_;
    bool ended_ = false;
    Clock::time_point checked_ = Clock::now();
};

/// The id of the last event that the client has: what EventSource sends, or a query field.
std::optional<std::uint64_t> last_event_id(const http::Request& request) {
    if (const auto header = request.header("last-event-id"); header && !header->empty())
        return parse_number(*header).value_or(0);  // a foreign one hides nothing
    const auto text = request.query_value("lastEventId");
    if (!text) return std::nullopt;
    const auto number = parse_number(*text);
    if (!number) throw query_problem("lastEventId", "It is the id of an event, a whole number.");
    return number;
}

}  // namespace

http::Response get_events(Services& services, http::Request& request) {
    allow_query(request, {"lastEventId"});
    const StatusInfo job = require_job(services, request.path_parameters.at(0)).info;
    const auto last = last_event_id(request);
    http::Response response;
    response.set("Cache-Control", "no-cache");
    response.set("X-Accel-Buffering", "no");  // a proxy in front shall pass on each event at once
    const bool told = last && services.events.knows(job.job_id) &&
                      services.events.after(job.job_id, *last).empty();
    if (told && is_finished(job.status)) {
        response.status = 204;  // EventSource stops coming back
        return response;
    }
    response.content_type = "text/event-stream";
    response.feed = std::make_shared<StoryFeed>(services, job, last.value_or(0));
    return response;
}

}  // namespace lpf::server

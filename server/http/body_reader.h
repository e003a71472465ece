#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "server/http/chunks.h"
#include "server/http/connection.h"
#include "server/http/inflater.h"

namespace lpf::http {

/// Reads a request's body off its connection: framing, compression, pace and size. Blocks.
class BodyReader {
public:
    BodyReader(Connection& connection, const Head& head, const Limits& limits);

    /// @returns false if the client left before the end, or the sink wanted no more
    /// @throws ProblemException 400 for broken framing or compression, 408 for a client that is
    /// too slow, 413 for more than `uploadBytes`, before or after the inflation
    bool read(const BodySink& sink);

    /// The same for a form. @throws ProblemException 400 where the body is none
    bool read_form(const PartSink& part, const BodySink& sink);

    /// True when nothing of the body is left on the connection: the next request may follow.
    [[nodiscard]] bool finished() const {
        return intact_ && (head_.chunked ? chunks_.finished() : left_ == 0);
    }

private:
    /// @returns false if the client has left
    bool fetch();
    void invite();
    void keep_pace() const;
    /// Gives out what is data of the received bytes. @returns false if the sink wanted no more
    bool unframe(const BodySink& sink);
    bool unpack(std::string_view piece, const BodySink& sink);

    Connection& connection_;
    const Head& head_;
    const Limits& limits_;
    Clock::time_point begin_ = Clock::now();
    std::uint64_t left_;  // without chunks
    ChunkDecoder chunks_;
    std::optional<Inflater> inflater_;
    std::uint64_t received_ = 0;
    std::uint64_t inflated_ = 0;
    bool invited_ = false;
    bool intact_ = true;  // false once an exception has left bytes behind that were used
};

}  // namespace lpf::http

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace lpf::http {

/// Takes a chunked body apart (RFC 9112, Sec. 7.1), strictly: the transport library takes sizes
/// with signs, prefixes and rubbish behind them, and lines that end in a bare LF, each of which
/// another server may read in another way; and it refuses trailers.
class ChunkDecoder {
public:
    /// Takes bytes off the front of `input`, up to the end of the body, and gives the data to the
    /// sink. @returns false if the sink wanted no more
    /// @throws ProblemException 400 where the framing is broken
    bool decode(std::string_view& input, const BodySink& sink);

    [[nodiscard]] bool finished() const { return state_ == State::Done; }

private:
    enum class State { Size, Data, EndOfData, Trailer, Done };

    bool take_line(std::string_view& input);
    void end_line();
    void begin_chunk();
    void count_overhead();

    State state_ = State::Size;
    std::string line_;
    std::uint64_t left_ = 0;      // of the chunk
    std::uint64_t data_ = 0;      // in all
    std::uint64_t overhead_ = 0;  // bytes that are no data
};

}  // namespace lpf::http

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace lpf::http {

/// What a form may hold besides the bytes of its parts.
struct MultipartLimits {
    std::size_t parts = 100;
    std::size_t part_head_bytes = 16 * 1024;
    std::size_t part_head_fields = 16;
    std::size_t padding_bytes = 64 * 1024;  ///< before the first part, and after the last
};

/// The boundary that a Content-Type names (RFC 2046, Sec. 5.1.1).
/// @throws ProblemException 400 if there is none, or none that is allowed
[[nodiscard]] std::string multipart_boundary(std::string_view content_type);

/// The head of one part, from its first line up to and including the empty line.
/// @throws ProblemException 400 for a part without a name, and whatever breaks RFC 7578
[[nodiscard]] Part parse_part_head(std::string_view text, const MultipartLimits& limits);

/// Splits a multipart/form-data body (RFC 7578) that comes in pieces of any size. Holds no more of
/// it than the head of a part or the beginning of a boundary.
class MultipartSplitter {
public:
    /// @param part told each part's head @param data told the bytes of that part, in pieces
    MultipartSplitter(const std::string& boundary, MultipartLimits limits, PartSink part,
                      BodySink data);

    /// Takes the next bytes. @returns false once a sink has said that it wants no more
    /// @throws ProblemException 400 where the body is no form
    bool add(std::string_view bytes);

    /// True when the boundary that ends the form has come.
    [[nodiscard]] bool finished() const { return state_ == State::Epilogue; }

private:
    enum class State { Preamble, AfterBoundary, Head, Data, Epilogue };

    /// Each takes what it can from `rest`. @returns false when more bytes are needed
    bool step(std::string_view& rest);
    bool skip_preamble(std::string_view& rest);
    bool read_end_of_boundary(std::string_view& rest);
    bool read_head(std::string_view& rest);
    bool read_data(std::string_view& rest);
    bool skip_epilogue(std::string_view& rest);
    void give(std::string_view bytes);

    std::string delimiter_;  // with the line end before it, which is no part of the data
    MultipartLimits limits_;
    PartSink part_;
    BodySink data_;
    State state_ = State::Preamble;
    std::string buffered_ = "\r\n";  // the first boundary may stand at the very beginning
    std::size_t parts_ = 0;
    std::size_t padding_ = 0;
    bool stopped_ = false;
};

}  // namespace lpf::http

#include "server/http/chunks.h"

#include <algorithm>
#include <charconv>

#include "api/problem.h"

namespace lpf::http {
namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr std::size_t kMostDigits = 15;  // cannot overflow

[[noreturn]] void refuse(const std::string& detail) {
    throw ProblemException(ProblemCode::MalformedRequest, "The chunked body is broken: " + detail);
}

bool is_control(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t') || byte == 0x7f;
}

}  // namespace

bool ChunkDecoder::decode(std::string_view& input, const BodySink& sink) {
    while (!input.empty() && state_ != State::Done) {
        if (state_ != State::Data) {
            if (take_line(input)) end_line();
            continue;
        }
        const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(left_, input.size()));
        const std::string_view piece = input.substr(0, n);
        input.remove_prefix(n);
        left_ -= n;
        data_ += n;
        if (left_ == 0) state_ = State::EndOfData;
        if (!sink(piece)) return false;
    }
    return true;
}

/// @returns true when a whole line is in line_, without its end
bool ChunkDecoder::take_line(std::string_view& input) {
    const auto end = input.find('\n');
    const auto n = end == std::string_view::npos ? input.size() : end + 1;
    line_ += input.substr(0, std::min(n, kLongestLine + 1));
    input.remove_prefix(n);
    overhead_ += n;
    if (line_.size() > kLongestLine) refuse("a line is too long.");
    count_overhead();
    if (end == std::string_view::npos) return false;
    if (!line_.ends_with("\r\n")) refuse("a line does not end CR LF.");
    line_.resize(line_.size() - 2);
    if (std::ranges::any_of(line_, is_control)) refuse("a line holds a control character.");
    return true;
}

void ChunkDecoder::end_line() {
    switch (state_) {
        case State::Size: begin_chunk(); break;
        case State::EndOfData:
            if (!line_.empty()) refuse("a chunk is longer than it says.");
            state_ = State::Size;
            break;
        case State::Trailer:  // read over: nothing here asks for any
            if (line_.empty())
                state_ = State::Done;
            else if (line_.find(':') == std::string::npos)
                refuse("a trailer is no field.");
            break;
        case State::Data:
        case State::Done: break;
    }
    line_.clear();
}

void ChunkDecoder::begin_chunk() {
    const auto* end = line_.data() + line_.size();
    const auto [stop, error] = std::from_chars(line_.data(), end, left_, 16);
    const auto digits = static_cast<std::size_t>(stop - line_.data());
    // from_chars would take a minus as an error, but no sign and no 0x as digits.
    if (error != std::errc{} || digits == 0 || digits > kMostDigits)
        refuse("a size must be 1 to 15 hexadecimal digits.");
    const auto rest = std::string_view(line_).substr(digits);
    const auto extension = rest.find_first_not_of(" \t");
    if (!rest.empty() && (extension == std::string_view::npos || rest[extension] != ';'))
        refuse("a size is followed by neither an extension nor the end of its line.");
    state_ = left_ > 0 ? State::Data : State::Trailer;
}

/// Framing that dwarfs the data is an attack, not a way to send data.
void ChunkDecoder::count_overhead() {
    constexpr std::uint64_t kAllowed = 64 * 1024;
    constexpr std::uint64_t kPerByte = 8;
    if (overhead_ > kAllowed + kPerByte * data_) refuse("it is all framing and no data.");
}

}  // namespace lpf::http

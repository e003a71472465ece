#include "server/http/multipart.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "api/http_text.h"
#include "api/problem.h"

namespace lpf::http {
namespace {

constexpr std::string_view kEndOfLine = "\r\n";
constexpr std::string_view kEndOfHead = "\r\n\r\n";
constexpr std::size_t kLongestBoundary = 70;

[[noreturn]] void refuse(const std::string& detail) {
    throw ProblemException(ProblemCode::MalformedRequest, detail);
}

bool is_boundary(std::string_view text) {
    static constexpr std::string_view kMarks = "'()+_,-./:=? ";
    return !text.empty() && text.size() <= kLongestBoundary && text.back() != ' ' &&
           std::ranges::all_of(text, [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                      kMarks.find(c) != std::string_view::npos;
           });
}

void read_disposition(std::string_view value, Part& part) {
    if (bare_media_type(value) != "form-data")
        refuse("A part of the form is no form-data; its Content-Disposition must say so.");
    const auto name = header_parameter(value, "name");
    if (!name || name->empty()) {
        refuse(
            "A part of the form has no name. Write the header as "
            "Content-Disposition: form-data; name=\"file\"; filename=\"...\".");
    }
    part.name = *name;
    part.filename = header_parameter(value, "filename").value_or("");
    const auto extended = header_parameter(value, "filename*");
    if (!extended) return;
    const auto decoded = extended_value(*extended);
    if (!decoded) refuse("The filename* of a part must read UTF-8''name with %-escapes.");
    part.filename = *decoded;
}

/// Bytes as they are, or nothing: the encodings of mail are not for forms (RFC 7578, Sec. 4.7).
void require_plain(std::string_view encoding) {
    constexpr std::array<std::string_view, 3> kPlain{"binary", "8bit", "7bit"};
    if (std::ranges::find(kPlain, lower(encoding)) == kPlain.end())
        refuse("A part of the form has a Content-Transfer-Encoding; send its bytes as they are.");
}

}  // namespace

std::string multipart_boundary(std::string_view content_type) {
    const auto boundary = header_parameter(content_type, "boundary");
    if (!boundary || !is_boundary(*boundary)) {
        refuse(
            "The Content-Type must name the boundary of the form: 1 to 70 letters, digits or "
            "'()+_,-./:=? after boundary=.");
    }
    return *boundary;
}

Part parse_part_head(std::string_view text, const MultipartLimits& limits) {
    Part part;
    std::size_t fields = 0;
    bool described = false;
    while (!text.empty() && !text.starts_with(kEndOfLine)) {
        const auto end = std::min(text.find(kEndOfLine), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + kEndOfLine.size(), text.size()));
        const auto colon = line.find(':');
        const std::string name = lower(line.substr(0, std::min(colon, line.size())));
        if (colon == std::string_view::npos || name.empty() || has_control(line) ||
            name.find_first_of(" \t") != std::string::npos) {
            refuse("The head of a part must consist of lines 'Name: value'.");
        }
        if (++fields > limits.part_head_fields) refuse("A part of the form has too many headers.");
        const std::string_view value = trim(line.substr(colon + 1));
        if (name == "content-disposition") {
            if (described) refuse("A part of the form has two headers Content-Disposition.");
            described = true;
            read_disposition(value, part);
        }
        if (name == "content-type") part.content_type = value;
        if (name == "content-transfer-encoding") require_plain(value);
    }
    if (!described) refuse("A part of the form has no header Content-Disposition.");
    return part;
}

MultipartSplitter::MultipartSplitter(const std::string& boundary, MultipartLimits limits,
                                     PartSink part, BodySink data)
    : delimiter_("\r\n--" + boundary),
      limits_(limits),
      part_(std::move(part)),
      data_(std::move(data)) {}

bool MultipartSplitter::add(std::string_view bytes) {
    if (stopped_) return false;
    buffered_ += bytes;
    std::string_view rest = buffered_;
    while (!stopped_ && step(rest)) {
    }
    buffered_.erase(0, buffered_.size() - rest.size());
    return !stopped_;
}

bool MultipartSplitter::step(std::string_view& rest) {
    switch (state_) {
        case State::Preamble: return skip_preamble(rest);
        case State::AfterBoundary: return read_end_of_boundary(rest);
        case State::Head: return read_head(rest);
        case State::Data: return read_data(rest);
        case State::Epilogue: return skip_epilogue(rest);
    }
    return false;
}

bool MultipartSplitter::skip_preamble(std::string_view& rest) {
    const auto at = rest.find(delimiter_);
    const bool found = at != std::string_view::npos;
    const std::size_t kept = found ? 0 : std::min(rest.size(), delimiter_.size() - 1);
    const std::size_t skipped = found ? at : rest.size() - kept;
    padding_ += skipped;
    if (padding_ > limits_.padding_bytes)
        refuse("The body does not begin with the boundary that its Content-Type names.");
    rest.remove_prefix(skipped + (found ? delimiter_.size() : 0));
    if (found) state_ = State::AfterBoundary;
    return found;
}

bool MultipartSplitter::read_end_of_boundary(std::string_view& rest) {
    const auto start = rest.find_first_not_of(" \t");
    if (std::min(start, rest.size()) > kLongestBoundary)
        refuse("A boundary of the form is followed by too many blanks.");
    if (start == std::string_view::npos || rest.size() < start + 2) return false;
    const std::string_view mark = rest.substr(start, 2);
    if (mark == kEndOfLine) {
        // The line end stays: a head without a single header begins with its empty line.
        rest.remove_prefix(start);
        state_ = State::Head;
    } else if (mark == "--" && start == 0) {
        rest.remove_prefix(2);
        padding_ = 0;
        state_ = State::Epilogue;
    } else {
        refuse("A boundary of the form is followed by neither CR LF nor '--'.");
    }
    return true;
}

bool MultipartSplitter::read_head(std::string_view& rest) {
    const auto end = rest.substr(0, limits_.part_head_bytes).find(kEndOfHead);
    if (end == std::string_view::npos) {
        if (rest.size() >= limits_.part_head_bytes)
            refuse("The head of a part of the form is too large, or its lines do not end CR LF.");
        return false;
    }
    if (++parts_ > limits_.parts)
        refuse("The form has more than " + std::to_string(limits_.parts) + " parts.");
    const std::string_view head = rest.substr(0, end + kEndOfLine.size());
    rest.remove_prefix(end + kEndOfHead.size());
    state_ = State::Data;
    stopped_ = !part_(parse_part_head(head.substr(kEndOfLine.size()), limits_));
    return true;
}

bool MultipartSplitter::read_data(std::string_view& rest) {
    const auto at = rest.find(delimiter_);
    const bool found = at != std::string_view::npos;
    // What may be the beginning of a boundary waits for the bytes that tell.
    const auto doubtful =
        found ? at : rest.find('\r', rest.size() - std::min(rest.size(), delimiter_.size() - 1));
    const std::size_t given = std::min(doubtful, rest.size());
    give(rest.substr(0, given));
    rest.remove_prefix(given + (found ? delimiter_.size() : 0));
    if (found) state_ = State::AfterBoundary;
    return found;
}

bool MultipartSplitter::skip_epilogue(std::string_view& rest) {
    padding_ += rest.size();
    if (padding_ > limits_.padding_bytes) refuse("Too much follows the end of the form.");
    rest = {};
    return false;
}

void MultipartSplitter::give(std::string_view bytes) {
    if (!bytes.empty()) stopped_ = !data_(bytes);
}

}  // namespace lpf::http

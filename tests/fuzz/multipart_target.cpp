// Any bytes as a form, whole and in pieces: split in the same way or refused, and nothing is made
// up. The first byte says how large the pieces are.

#include <optional>

#include "api/problem.h"
#include "server/http/multipart.h"
#include "tests/fuzz/target.h"

namespace lpf::fuzz {
namespace {

/// What a form was split into, and whether it was complete.
struct Form {
    std::vector<std::pair<std::string, std::string>> parts;
    bool finished = false;

    bool operator==(const Form&) const = default;
};

/// Nothing if it was refused.
std::optional<Form> split(std::string_view body, std::size_t piece) {
    Form form;
    try {
        http::MultipartSplitter splitter(
            "b", {.parts = 8, .part_head_bytes = 512, .part_head_fields = 4, .padding_bytes = 256},
            [&](const http::Part& part) {
                form.parts.emplace_back(part.name, "");
                return true;
            },
            [&](std::string_view bytes) {
                require(!form.parts.empty(), "bytes belong to a part");
                form.parts.back().second += bytes;
                return true;
            });
        for (std::size_t at = 0; at < body.size(); at += piece) {
            require(splitter.add(body.substr(at, piece)), "only a sink ends the splitting");
        }
        form.finished = splitter.finished();
    } catch (const ProblemException& refused) {
        require(!refused.problem().detail.empty(), "a refusal says why");
        return std::nullopt;
    }
    return form;
}

void require_plausible(const Form& form, std::string_view body) {
    require(form.parts.size() <= 8, "no more parts than the limit");
    std::size_t bytes = 0;
    for (const auto& [name, data] : form.parts) {
        require(!name.empty(), "every part has a name");
        require(body.find(data) != body.npos, "a part is a piece of the body");
        require(data.find("\r\n--b\r\n") == data.npos, "no boundary is left in a part");
        bytes += data.size();
    }
    require(bytes <= body.size(), "no more comes out than went in");
}

}  // namespace

std::vector<std::string> seeds() {
    return {
        "\x01--b\r\nContent-Disposition: form-data; name=\"file\"; filename=\"a.ply\"\r\n"
        "Content-Type: application/octet-stream\r\n\r\nply\r\n--b--\r\n",
        "\x07preamble\r\n--b  \r\ncontent-disposition: form-data; name=atoms\r\n\r\n4\r\n"
        "--b\r\nContent-Disposition: form-data; filename*=UTF-8''x; name=\"a\\\"b\"\r\n\r\n"
        "\r\n--b-\r\n-\r\n--b--epilogue",
        "\xff--b\r\nContent-Disposition: form-data; name=\"x\"\r\n\r\n\r\n--c\r\n--bb\r\n--b--"};
}

}  // namespace lpf::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lpf::fuzz;
    if (size == 0) return 0;
    const std::string_view body = text_of(data + 1, size - 1);
    const auto whole = split(body, body.size() + 1);
    if (whole) require_plausible(*whole, body);
    // A form that is refused at its end may have been refused earlier or later in pieces, never
    // not.
    require(whole == split(body, std::size_t{data[0]} + 1), "pieces make no difference");
    return 0;
}

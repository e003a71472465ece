#include "server/http/inflater.h"

#include <zlib.h>

#include <vector>

#include "api/problem.h"

namespace lpf::http {
namespace {

constexpr std::size_t kPiece = 64 * 1024;
constexpr int kGzipOnly = 16 + MAX_WBITS;

}  // namespace

struct Inflater::State {
    z_stream stream{};
    std::vector<Bytef> out = std::vector<Bytef>(kPiece);
    bool finished = false;
};

Inflater::Inflater() : state_(std::make_unique<State>()) {
    if (::inflateInit2(&state_->stream, kGzipOnly) != Z_OK) throw std::bad_alloc();
}

Inflater::~Inflater() { ::inflateEnd(&state_->stream); }

bool Inflater::finished() const { return state_->finished; }

bool Inflater::add(std::string_view compressed, const BodySink& sink) {
    z_stream& stream = state_->stream;
    // zlib's interface predates const.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
    stream.avail_in = static_cast<uInt>(compressed.size());
    bool full = false;
    while (stream.avail_in > 0 || full) {
        if (state_->finished) {  // several members make one file (RFC 1952, Sec. 2.2)
            ::inflateReset(&stream);
            state_->finished = false;
        }
        stream.next_out = state_->out.data();
        stream.avail_out = kPiece;
        const int result = ::inflate(&stream, Z_NO_FLUSH);
        if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) {
            throw ProblemException(ProblemCode::MalformedRequest,
                                   "The body is not the gzip that its Content-Encoding says.");
        }
        const std::size_t made = kPiece - stream.avail_out;
        state_->finished = result == Z_STREAM_END;
        full = stream.avail_out == 0 && !state_->finished;
        const auto* text = reinterpret_cast<const char*>(state_->out.data());
        if (made > 0 && !sink({text, made})) return false;
    }
    return true;
}

}  // namespace lpf::http

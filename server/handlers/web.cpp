#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/site/web_files.h"

namespace lpf::server {
namespace {

// Scripts, styles and workers of this host only; WebAssembly for the Draco decoder.
constexpr const char* kPagePolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; "
    "img-src 'self' data: blob:; font-src 'self'; connect-src 'self' blob:; "
    "worker-src 'self' blob:; base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

// The plain page has one style sheet inside, and nothing else.
constexpr const char* kPlainPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

http::Response plain_page() {
    http::Response response;
    response.content_type = "text/html; charset=utf-8";
    response.body = plain_index(version());
    response.set("Content-Security-Policy", kPlainPolicy);
    return response;
}

/// The folder that was named, or else the one that was built with this program.
const std::filesystem::path& web_dir(const Config& config) {
    static const std::filesystem::path built = web_dir_of("/proc/self/exe");
    return config.web_dir.empty() ? built : config.web_dir;
}

/// Files below /assets/ have a hash of their content in their names.
const char* caching(std::string_view path) {
    return path.starts_with("/assets/") ? "public, max-age=31536000, immutable" : "no-cache";
}

}  // namespace

http::Response get_web_file(Services& services, http::Request& request) {
    request.route = "web";
    const auto file = web_file(web_dir(services.config), request.path);
    if (!file && request.path == "/") return plain_page();
    if (!file) {
        throw ProblemException(ProblemCode::NotFound,
                               "There is nothing at this path. The API starts at /v1/, and "
                               "/v1/openapi.json describes it.");
    }
    http::Response response;
    response.content_type = std::string(web_type(*file));
    response.file = http::FileSlice{*file, 0, std::filesystem::file_size(*file)};
    response.set("Content-Security-Policy", kPagePolicy);
    response.set("Cache-Control", caching(request.path));
    return response;
}

}  // namespace lpf::server

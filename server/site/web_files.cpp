#include "server/site/web_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace lpf::server {
namespace fs = std::filesystem;
namespace {

bool is_plain_name(std::string_view name) {
    return !name.empty() && name.front() != '.' &&
           std::all_of(name.begin(), name.end(), [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' ||
                      c == '_';
           });
}

bool is_inside(const fs::path& folder, const fs::path& file) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
           folder.end();
}

}  // namespace

std::optional<fs::path> web_file(const fs::path& folder, std::string_view path) {
    if (folder.empty() || !path.starts_with('/')) return std::nullopt;
    path.remove_prefix(1);
    std::string wanted(path);
    if (wanted.empty() || wanted.ends_with('/')) wanted += "index.html";
    fs::path file = folder;
    for (const fs::path& name : fs::path(wanted)) {
        if (!is_plain_name(name.string())) return std::nullopt;
        file /= name;
    }
    std::error_code error;
    const fs::path real = fs::canonical(file, error);
    if (error || !fs::is_regular_file(real, error)) return std::nullopt;
    return is_inside(fs::canonical(folder, error), real) ? std::optional(real) : std::nullopt;
}

fs::path web_dir_of(const fs::path& executable) {
    std::error_code error;
    const fs::path real = fs::canonical(executable, error);
    if (error) return {};
    fs::path folder = real.parent_path().parent_path() / "share" / "lpf-server" / "web";
    return fs::is_regular_file(folder / "index.html", error) ? folder : fs::path();
}

std::string_view web_type(const fs::path& file) {
    using Row = std::pair<std::string_view, std::string_view>;
    constexpr std::array<Row, 12> kTypes{{{".html", "text/html; charset=utf-8"},
                                          {".js", "text/javascript; charset=utf-8"},
                                          {".mjs", "text/javascript; charset=utf-8"},
                                          {".css", "text/css; charset=utf-8"},
                                          {".json", "application/json"},
                                          {".wasm", "application/wasm"},
                                          {".svg", "image/svg+xml"},
                                          {".png", "image/png"},
                                          {".ico", "image/x-icon"},
                                          {".txt", "text/plain; charset=utf-8"},
                                          {".ply", "application/ply"},
                                          {".drc", "application/vnd.draco"}}};
    const std::string ending = file.extension().string();
    for (const auto& [name, type] : kTypes)
        if (ending == name) return type;
    return "application/octet-stream";
}

std::string plain_index(std::string_view version) {
    return R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>LPF Server</title>
<style>
:root { color-scheme: light dark; }
body { font: 1.05rem/1.6 system-ui, sans-serif; max-width: 46rem; margin: 3rem auto; padding: 0 1rem; }
pre { overflow-x: auto; padding: 1rem; border: 1px solid; border-radius: .4rem; }
</style>
</head>
<body>
<main>
<h1>LPF Server</h1>
<p>This service denoises, resamples and analyses point clouds and triangle meshes
(PLY or Draco) with Local Probing Fields. Version )" +
           std::string(version) + R"(.</p>
<h2>Try it</h2>
<p>Send a scan, get it back without its noise:</p>
<pre><code>curl --data-binary @scan.ply -H 'Prefer: wait=60' \
     'http://127.0.0.1:8080/v1/processes/denoise/execution' -o denoised.ply</code></pre>
<p>No parameter is needed: what is left open is chosen from the data. Use the host and port under
which you see this page.</p>
<h2>The interface</h2>
<ul>
<li><a href="/v1/">The API's landing page</a></li>
<li><a href="/v1/openapi.json">Its description as OpenAPI</a></li>
<li><a href="/v1/processes">What it can do</a></li>
<li><a href="/v1/jobs">What it is doing</a></li>
</ul>
</main>
</body>
</html>
)";
}

}  // namespace lpf::server

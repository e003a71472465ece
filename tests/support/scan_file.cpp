#include "tests/support/scan_file.h"

#include <fstream>
#include <iterator>
#include <span>
#include <utility>

#include "core/base/error.h"

namespace lpf::test {

Document read_scan(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(ErrorCode::StorageFailure, "The file " + path + " cannot be read.");
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    return decode(std::as_bytes(std::span(bytes)));
}

Shape read_mesh(const std::string& path) {
    Document document = read_scan(path);
    if (document.shape.is_mesh()) return std::move(document.shape);
    throw Error(ErrorCode::InvalidParameter,
                "The file " + path + " has no triangles; a mesh is needed.", "mesh");
}

}  // namespace lpf::test

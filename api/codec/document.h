#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/shape/shape.h"

namespace lpf {

/// Something the user should know although the work goes on. `code` is for programs, e.g.
/// "non-finite-points-dropped"; `detail` is one sentence with the figures.
struct Warning {
    std::string code;
    std::string detail;
};

enum class FileFormat { PlyBinary, PlyAscii, PlyBigEndian, Draco };

/// An element of a PLY file that is neither points nor faces, kept as columns.
struct Element {
    std::string name;
    std::size_t rows = 0;
    std::vector<Attribute> attributes;
};

/// Faces as the file had them, needed only where some are not triangles.
struct Polygons {
    std::vector<std::uint64_t> offsets;   ///< faces + 1 offsets into `vertices`; empty: no polygons
    std::vector<std::uint32_t> vertices;  ///< vertex indices of all faces in a row

    [[nodiscard]] bool empty() const { return offsets.empty(); }
    [[nodiscard]] std::size_t size() const { return empty() ? 0 : offsets.size() - 1; }
};

/// A file's whole content: the shape that is worked on, and everything else it said, so that a
/// result can say it again.
struct Document {
    Shape shape;  ///< finite points only; polygons as fans of triangles
    FileFormat format = FileFormat::PlyBinary;  ///< what it was decoded from
    std::vector<Element> elements;              ///< other than vertex and face, in file order
    Polygons polygons;                          ///< empty when every face is a triangle
    std::vector<Attribute> face_attributes;     ///< @invariant each has face_count() rows
    std::vector<std::string> comments;
    std::vector<std::string> obj_info;
    bool double_positions = false;   ///< coordinates that float32 might not hold
    std::size_t dropped_points = 0;  ///< points left out because a coordinate was NaN or infinite
    std::vector<Warning> warnings;

    /// Faces as the file counts them: polygons if there are any, else triangles.
    [[nodiscard]] std::size_t face_count() const {
        return polygons.empty() ? static_cast<std::size_t>(shape.triangles.cols())
                                : polygons.size();
    }
};

/// The same document with other points. Where `keeps_vertices` (the same number in the same order,
/// as after denoising), faces and all elements stay; otherwise whatever refers to points by number
/// goes, and a warning `faces-dropped` or `element-dropped` names it.
/// @pre keeps_vertices implies cloud.size() == source.shape.size()
[[nodiscard]] Document with_points(const Document& source, PointCloud cloud, bool keeps_vertices);

}  // namespace lpf

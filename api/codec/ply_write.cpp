#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "api/codec/names.h"
#include "api/codec/ply.h"
#include "api/codec/ply_header.h"
#include "api/codec/ply_rows.h"
#include "api/codec/positions.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

ScalarType smallest_count_type(std::uint64_t longest) {
    if (longest <= std::numeric_limits<std::uint8_t>::max()) return ScalarType::UInt8;
    if (longest <= std::numeric_limits<std::uint16_t>::max()) return ScalarType::UInt16;
    return ScalarType::UInt32;
}

std::uint64_t longest_list(std::span<const std::uint64_t> offsets) {
    std::uint64_t longest = 0;
    for (std::size_t i = 1; i < offsets.size(); ++i) {
        longest = std::max(longest, offsets[i] - offsets[i - 1]);
    }
    return longest;
}

/// The type that the file had, unless a list has become too long for it.
ScalarType count_type_for(const Attribute& attribute) {
    const std::uint64_t longest = longest_list(attribute.list_offsets);
    const std::size_t needed = size_of(smallest_count_type(longest));
    const bool is_unsigned = attribute.count_type == ScalarType::UInt8 ||
                             attribute.count_type == ScalarType::UInt16 ||
                             attribute.count_type == ScalarType::UInt32;
    const bool fits = size_of(attribute.count_type) >= needed &&
                      (is_unsigned || longest <= 127 || size_of(attribute.count_type) > needed);
    return fits ? attribute.count_type : smallest_count_type(longest);
}

class PlyWriter {
public:
    PlyWriter(const Document& document, const EncodeOptions& options, std::vector<Warning>& lost,
              const Execution& execution)
        : document_(document),
          options_(options),
          lost_(lost),
          execution_(execution),
          double_positions_(options.double_positions ||
                            exceed_float32(document.shape.cloud.points)) {}

    std::string write() {
        add_vertices();
        add_faces();
        for (const Element& element : document_.elements) add_element(element);
        std::string out = header();
        reserve_rows(out);
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            const Execution part = part_for(i);
            if (options_.format == FileFormat::PlyAscii) {
                write_ascii_rows(elements_[i], out, part);
            } else {
                write_binary_rows(elements_[i], options_.format == FileFormat::PlyBigEndian, out,
                                  part);
            }
        }
        return out;
    }

private:
    void add_vertices();
    void add_faces();
    void add_element(const Element& element);
    void add_attributes(PlyOutputElement& element, const std::vector<Attribute>& attributes,
                        NameSet& names);
    void add_coordinates(PlyOutputElement& vertex);
    [[nodiscard]] std::string header() const;
    void reserve_rows(std::string& out) const;
    [[nodiscard]] Execution part_for(std::size_t element) const;

    const Document& document_;
    const EncodeOptions& options_;
    std::vector<Warning>& lost_;
    const Execution& execution_;
    bool double_positions_;
    std::vector<std::vector<std::byte>> coordinates_;
    std::vector<PlyOutputElement> elements_;
};

template <typename T>
std::vector<std::byte> coordinate_column(const Points& points, Eigen::Index axis,
                                         const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<std::byte> column(n * sizeof(T));
    parallel_for(execution, n, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         const T value = static_cast<T>(points(axis, static_cast<Eigen::Index>(i)));
                         std::memcpy(column.data() + i * sizeof value, &value, sizeof value);
                     }
                 });
    return column;
}

void PlyWriter::add_coordinates(PlyOutputElement& vertex) {
    const Points& points = document_.shape.cloud.points;
    coordinates_.reserve(3);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        throw_if_cancelled(execution_);
        coordinates_.push_back(double_positions_
                                   ? coordinate_column<double>(points, axis, execution_)
                                   : coordinate_column<float>(points, axis, execution_));
        PlyOutputColumn column;
        column.name = std::string(1, "xyz"[axis]);
        column.type = double_positions_ ? ScalarType::Float64 : ScalarType::Float32;
        column.data = coordinates_.back().data();
        vertex.columns.push_back(std::move(column));
    }
}

void PlyWriter::add_vertices() {
    PlyOutputElement vertex{"vertex", document_.shape.size(), {}};
    add_coordinates(vertex);
    NameSet names({"x", "y", "z"});
    add_attributes(vertex, document_.shape.cloud.attributes, names);
    elements_.push_back(std::move(vertex));
}

void PlyWriter::add_faces() {
    const std::size_t faces = document_.face_count();
    if (faces == 0) return;
    PlyOutputElement face{"face", faces, {}};
    PlyOutputColumn column;
    column.name = "vertex_indices";
    const bool fits_int = document_.shape.size() <= std::numeric_limits<std::int32_t>::max();
    column.type = fits_int ? ScalarType::Int32 : ScalarType::UInt32;
    column.is_list = true;
    if (document_.polygons.empty()) {
        column.common_length = 3;
        column.data = reinterpret_cast<const std::byte*>(document_.shape.triangles.data());
    } else {
        column.offsets = document_.polygons.offsets;
        column.data = reinterpret_cast<const std::byte*>(document_.polygons.vertices.data());
        column.count_type = smallest_count_type(longest_list(column.offsets));
    }
    face.columns.push_back(std::move(column));
    NameSet names({"vertex_indices", "vertex_index"});
    add_attributes(face, document_.face_attributes, names);
    elements_.push_back(std::move(face));
}

void PlyWriter::add_element(const Element& element) {
    PlyOutputElement output{element.name, element.rows, {}};
    // Here are no faces: no name may become that of a list of vertices by being made fit to print.
    NameSet names({"vertex_indices", "vertex_index"});
    add_attributes(output, element.attributes, names);
    if (output.columns.empty()) output.rows = 0;
    elements_.push_back(std::move(output));
}

void PlyWriter::add_attributes(PlyOutputElement& element, const std::vector<Attribute>& attributes,
                               NameSet& names) {
    for (const Attribute& attribute : attributes) {
        if (attribute.rows() != element.rows) {
            fail(ErrorCode::Internal, "attribute ", quoted(attribute.name), " has ",
                 attribute.rows(), " rows, but element ", quoted(element.name), " has ",
                 element.rows);
        }
        PlyOutputColumn column;
        column.name = names.claim(attribute.name);
        column.type = attribute.type;
        column.data = attribute.data.data();
        column.is_list = attribute.is_list();
        column.offsets = attribute.list_offsets;
        if (column.is_list) column.count_type = count_type_for(attribute);
        if (column.name != attribute.name) {
            lost_.push_back({"attribute-renamed",
                             message_of("attribute ", quoted(attribute.name), " is written as ",
                                        quoted(column.name), ": a PLY name is one unique word")});
        }
        element.columns.push_back(std::move(column));
    }
}

std::string PlyWriter::header() const {
    PlyHeader header{.format = options_.format,
                     .elements = {},
                     .comments = options_.comments,
                     .obj_info = document_.obj_info};
    header.comments.insert(header.comments.end(), document_.comments.begin(),
                           document_.comments.end());
    for (const PlyOutputElement& element : elements_) {
        PlyElement& listed = header.elements.emplace_back();
        listed.name = element.name;
        listed.count = element.rows;
        for (const PlyOutputColumn& column : element.columns) {
            listed.properties.push_back(
                {column.name, column.type, column.is_list, column.count_type});
        }
    }
    return ply_header_text(header);
}

/// Makes room for binary rows exactly, and for ASCII rows roughly.
void PlyWriter::reserve_rows(std::string& out) const {
    std::size_t bytes = out.size();
    for (const PlyOutputElement& element : elements_) {
        for (const PlyOutputColumn& column : element.columns) {
            std::size_t values = element.rows;
            if (column.is_list) {
                values = column.list_begin(element.rows);
                bytes += element.rows * size_of(column.count_type);
            }
            bytes += values * size_of(column.type);
        }
    }
    out.reserve(options_.format == FileFormat::PlyAscii ? 2 * bytes : bytes);
}

/// The part of the bar that the rows of one element fill.
Execution PlyWriter::part_for(std::size_t element) const {
    double before = 0;
    double all = 1;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        if (i < element) before += static_cast<double>(elements_[i].rows);
        all += static_cast<double>(elements_[i].rows);
    }
    return part_of(execution_, before / all,
                   (before + static_cast<double>(elements_[element].rows)) / all);
}

}  // namespace

std::string encode_ply(const Document& document, const EncodeOptions& options,
                       std::vector<Warning>& lost, const Execution& execution) {
    return PlyWriter(document, options, lost, execution).write();
}

}  // namespace lpf

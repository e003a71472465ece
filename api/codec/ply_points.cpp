#include "api/codec/ply_points.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "api/codec/ply.h"
#include "api/codec/ply_checks.h"
#include "api/codec/ply_columns.h"

namespace lpf {
namespace {

constexpr std::size_t kBytesOfPiece = 1U << 20U;    // written at a time
constexpr std::size_t kBytesInMemory = 64U << 20U;  // of the file, before they are let go of

bool has_rows_of_one_length(const PlyElement& element) {
    return std::ranges::none_of(element.properties, &PlyProperty::is_list);
}

bool has_points_alone(const PlyHeader& header) {
    return std::ranges::all_of(header.elements, [](const PlyElement& element) {
        return element.name == "vertex" ? has_rows_of_one_length(element) : element.count == 0;
    });
}

template <typename T>
double read_value(const std::byte* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

template <typename T>
double put_value(double position, std::byte* to) {
    const T value = static_cast<T>(position);
    std::memcpy(to, &value, sizeof value);
    return static_cast<double>(value);
}

PlyHeader with_points(PlyHeader header, std::uint64_t count) {
    for (PlyElement& element : header.elements) {
        if (element.name == "vertex") element.count = count;
    }
    return header;
}

void append(std::span<const std::byte> bytes, std::string& out) {
    out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

}  // namespace

std::optional<PlyPoints> PlyPoints::open(std::span<const std::byte> file,
                                         const DecodeLimits& limits, std::function<void()> let_go) {
    if (sniff(file) != FileFormat::PlyBinary) return std::nullopt;
    PlyPoints points;
    points.file_ = file;
    points.let_go_ = std::move(let_go);
    points.header_ = parse_ply_header(file);
    check_ply_claims(points.header_, file.size(), limits);
    if (!has_points_alone(points.header_)) return std::nullopt;
    for (const PlyProperty& property : ply_vertices(points.header_).properties) {
        const std::size_t axis = std::string_view("xyz").find(property.name);
        if (property.name.size() == 1 && axis != std::string_view::npos) {
            const bool is_double = property.type == ScalarType::Float64;
            if (!is_double && property.type != ScalarType::Float32) return std::nullopt;
            points.coordinates_[axis] = {points.row_bytes_, is_double};
        }
        points.row_bytes_ += size_of(property.type);
    }
    return points;
}

const PlyElement& PlyPoints::vertices() const { return ply_vertices(header_); }

std::size_t PlyPoints::size() const { return vertices().count; }

Eigen::Vector3d PlyPoints::position(std::size_t i) const {
    const std::byte* const from = file_.data() + header_.bytes + i * row_bytes_;
    Eigen::Vector3d position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Coordinate& c = coordinates_[axis];
        position[static_cast<Eigen::Index>(axis)] =
            c.is_double ? read_value<double>(from + c.offset) : read_value<float>(from + c.offset);
    }
    return position;
}

Eigen::Vector3d PlyPoints::put(const Eigen::Vector3d& position, std::span<std::byte> row) const {
    Eigen::Vector3d stored;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Coordinate& c = coordinates_[axis];
        const auto at = static_cast<Eigen::Index>(axis);
        std::byte* const to = row.data() + c.offset;
        stored[at] =
            c.is_double ? put_value<double>(position[at], to) : put_value<float>(position[at], to);
    }
    return stored;
}

void PlyPoints::read(std::size_t begin, Points& points) const {
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        points.col(i) = position(begin + static_cast<std::size_t>(i));
    }
}

void PlyPoints::read(std::span<const std::uint32_t> indices, Points& points) const {
    points.resize(3, static_cast<Eigen::Index>(indices.size()));
    const std::size_t rows = std::max<std::size_t>(1, kBytesInMemory / row_bytes_);
    std::size_t next = rows;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        // The points may lie all over the file.
        if (indices[i] >= next) {
            let_go();
            next = indices[i] + rows;
        }
        points.col(static_cast<Eigen::Index>(i)) = position(indices[i]);
    }
}

Document first_rows(const PlyPoints& points, std::size_t rows, const DecodeLimits& limits) {
    const std::size_t count = std::min(rows, points.size());
    std::string file = ply_header_text(with_points(points.header(), count));
    for (std::size_t i = 0; i < count; ++i) append(points.row(i), file);
    return decode_ply(std::as_bytes(std::span(file)), limits);
}

WrittenPoints write_moved(const PlyPoints& points, std::span<const Eigen::Vector3f> moves,
                          std::uint64_t finite, const std::string& comment,
                          const std::function<void(std::string_view)>& write,
                          const Execution& execution) {
    PlyHeader header = with_points(points.header(), finite);
    header.comments.insert(header.comments.begin(), comment);
    write(ply_header_text(header));
    WrittenPoints written;
    std::string piece;
    const auto write_row = [&](std::size_t i) {
        const Eigen::Vector3d before = points.position(i);
        if (!before.allFinite()) return;
        const std::span<const std::byte> row = points.row(i);
        append(row, piece);
        const Eigen::Vector3d now =
            points.put(before + moves[i].cast<double>(),
                       std::as_writable_bytes(std::span(piece).last(row.size())));
        if (written.points++ == 0) written.minimum = written.maximum = now;
        written.minimum = written.minimum.cwiseMin(now);
        written.maximum = written.maximum.cwiseMax(now);
    };
    const std::size_t rows = std::max<std::size_t>(1, kBytesOfPiece / points.row_bytes());
    parallel_for(on_one_thread(execution), kEncodePhase, "rows", points.size(), rows,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     piece.clear();
                     for (std::size_t i = begin; i < end; ++i) write_row(i);
                     write(piece);
                     points.let_go();
                 });
    return written;
}

}  // namespace lpf

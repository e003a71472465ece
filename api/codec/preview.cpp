#include "api/codec/preview.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>

#include "core/base/error.h"
#include "core/base/random.h"

namespace lpf {
namespace {

constexpr std::array<std::array<std::string_view, 3>, 3> kColourNames{
    {{"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}}};

/// Coordinates up to this many diagonals lose less than a millionth part of one in float32.
constexpr double kNearOrigin = 16.0;

constexpr std::string_view kOffset = "offset ";
constexpr std::string_view kSource = "points of the whole: ";

/// Rows to pick: one at random out of each of as many equal stretches as points are wanted.
std::vector<std::uint64_t> pick(std::uint64_t rows, std::size_t most) {
    const std::uint64_t count = std::min<std::uint64_t>(rows, most);
    std::vector<std::uint64_t> picked(count);
    Random random(rows, 0x9e11);
    const double stretch = static_cast<double>(rows) / static_cast<double>(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        const double at = rows == count ? static_cast<double>(i)
                                        : (static_cast<double>(i) + random.uniform()) * stretch;
        picked[i] = std::min(static_cast<std::uint64_t>(at), rows - 1);
    }
    return picked;
}

template <typename T>
double load_as(const std::byte* at, bool swap) {
    std::array<std::byte, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), at, sizeof(T));
    if (swap) std::ranges::reverse(bytes);
    return static_cast<double>(std::bit_cast<T>(bytes));
}

double load(const std::byte* at, ScalarType type, bool swap) {
    switch (type) {
        case ScalarType::Int8: return load_as<std::int8_t>(at, swap);
        case ScalarType::UInt8: return load_as<std::uint8_t>(at, swap);
        case ScalarType::Int16: return load_as<std::int16_t>(at, swap);
        case ScalarType::UInt16: return load_as<std::uint16_t>(at, swap);
        case ScalarType::Int32: return load_as<std::int32_t>(at, swap);
        case ScalarType::UInt32: return load_as<std::uint32_t>(at, swap);
        case ScalarType::Float32: return load_as<float>(at, swap);
        case ScalarType::Float64: return load_as<double>(at, swap);
    }
    return 0;
}

/// A channel of a colour, of any type, in 0 to 255.
std::uint8_t channel(double value, ScalarType type) {
    const bool fraction = type == ScalarType::Float32 || type == ScalarType::Float64;
    const double scale = fraction ? 255.0 : type == ScalarType::UInt16 ? 255.0 / 65535.0 : 1.0;
    const double scaled = std::round(value * scale);
    return static_cast<std::uint8_t>(scaled > 0 ? std::min(scaled, 255.0) : 0.0);  // NaN: 0
}

/// Where a property lies in a row.
struct Place {
    std::size_t offset = 0;
    ScalarType type = ScalarType::Float32;
};

/// How the rows of a vertex element are laid out. Nothing if their length is not fixed.
struct RowLayout {
    std::size_t bytes = 0;
    std::array<std::optional<Place>, 3> axes;
    std::array<std::optional<Place>, 3> colour;

    [[nodiscard]] static std::optional<RowLayout> of(const PlyElement& element) {
        RowLayout layout;
        for (const PlyProperty& property : element.properties) {
            if (property.is_list) return std::nullopt;
            layout.note(property);
            layout.bytes += size_of(property.type);
        }
        const auto there = [](const auto& place) { return place.has_value(); };
        if (!std::ranges::all_of(layout.axes, there)) return std::nullopt;
        if (!std::ranges::all_of(layout.colour, there)) layout.colour = {};
        return layout;
    }

private:
    void note(const PlyProperty& property) {
        constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
        for (std::size_t c = 0; c < 3; ++c) {
            if (property.name == kAxes[c]) axes[c] = Place{bytes, property.type};
            for (const auto& names : kColourNames)
                if (property.name == names[c]) colour[c] = Place{bytes, property.type};
        }
    }
};

const Attribute* find_attribute(const PointCloud& cloud, std::string_view name) {
    const auto found = std::ranges::find(cloud.attributes, name, &Attribute::name);
    return found == cloud.attributes.end() || found->is_list() ? nullptr : &*found;
}

std::array<const Attribute*, 3> colour_columns(const PointCloud& cloud) {
    for (const auto& names : kColourNames) {
        const std::array<const Attribute*, 3> columns{find_attribute(cloud, names[0]),
                                                      find_attribute(cloud, names[1]),
                                                      find_attribute(cloud, names[2])};
        if (columns[0] && columns[1] && columns[2]) return columns;
    }
    return {};
}

/// What float32 cannot hold well is told relative to the centre of the box.
Eigen::Vector3d offset_of(const Points& points) {
    if (points.cols() == 0) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d low = points.rowwise().minCoeff();
    const Eigen::Vector3d high = points.rowwise().maxCoeff();
    const double farthest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
    if (farthest <= kNearOrigin * (high - low).norm()) return Eigen::Vector3d::Zero();
    return 0.5 * (low + high);
}

std::string header_of(const PointSample& sample, const Eigen::Vector3d& offset) {
    std::ostringstream text;
    text.precision(17);
    text << "ply\nformat binary_little_endian 1.0\ncomment " << kOffset << offset.x() << ' '
         << offset.y() << ' ' << offset.z() << "\ncomment " << kSource << sample.total
         << "\nelement vertex " << sample.points.cols()
         << "\nproperty float x\nproperty float y\nproperty float z\n";
    if (!sample.colours.empty())
        text << "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    text << "end_header\n";
    return text.str();
}

}  // namespace

std::optional<PointSample> sample_rows(std::span<const std::byte> file, std::size_t most) {
    const PlyHeader header = parse_ply_header(file);
    if (header.format == FileFormat::PlyAscii || header.elements.empty()) return std::nullopt;
    const PlyElement& vertex = header.elements.front();
    const auto layout = vertex.name == "vertex" ? RowLayout::of(vertex) : std::nullopt;
    if (!layout || (file.size() - header.bytes) / layout->bytes < vertex.count) return std::nullopt;
    const bool swap = header.format == FileFormat::PlyBigEndian;  // the machine's order is little

    PointSample sample;
    sample.total = vertex.count;
    const auto rows = pick(vertex.count, most);
    sample.points.resize(3, static_cast<Eigen::Index>(rows.size()));
    Eigen::Index kept = 0;
    for (const std::uint64_t row : rows) {
        const std::byte* at = file.data() + header.bytes + row * layout->bytes;
        Eigen::Vector3d point;
        for (std::size_t c = 0; c < 3; ++c)
            point[static_cast<Eigen::Index>(c)] =
                load(at + layout->axes[c]->offset, layout->axes[c]->type, swap);
        if (!point.allFinite()) continue;
        sample.points.col(kept++) = point;
        if (!layout->colour[0]) continue;
        auto& colour = sample.colours.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
            const Place& place = *layout->colour[c];
            colour[c] = channel(load(at + place.offset, place.type, swap), place.type);
        }
    }
    sample.points.conservativeResize(3, kept);
    return sample;
}

PointSample sample_document(const Document& document, std::size_t most) {
    const PointCloud& cloud = document.shape.cloud;
    PointSample sample;
    sample.total = cloud.size();
    const auto rows = pick(cloud.size(), most);
    const auto colour = colour_columns(cloud);
    sample.points.resize(3, static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        sample.points.col(static_cast<Eigen::Index>(i)) =
            cloud.points.col(static_cast<Eigen::Index>(rows[i]));
        if (!colour[0]) continue;
        auto& rgb = sample.colours.emplace_back();
        for (std::size_t c = 0; c < 3; ++c)
            rgb[c] = channel(value_at(*colour[c], rows[i]), colour[c]->type);
    }
    return sample;
}

std::string encode_preview(const PointSample& sample) {
    const Eigen::Vector3d offset = offset_of(sample.points);
    std::string out = header_of(sample, offset);
    const std::size_t row = sample.colours.empty() ? 12 : 15;
    std::size_t at = out.size();
    out.resize(at + row * static_cast<std::size_t>(sample.points.cols()));
    for (Eigen::Index i = 0; i < sample.points.cols(); ++i, at += row) {
        const Eigen::Vector3f point = (sample.points.col(i) - offset).cast<float>();
        std::memcpy(out.data() + at, point.data(), 12);
        if (row > 12)
            std::memcpy(out.data() + at + 12, sample.colours[static_cast<std::size_t>(i)].data(),
                        3);
    }
    return out;
}

PreviewHead read_preview_head(std::span<const std::byte> file) {
    const PlyHeader header = parse_ply_header(file);
    PreviewHead head;
    head.points = header.elements.at(0).count;
    for (const std::string& comment : header.comments) {
        if (comment.starts_with(kOffset)) {
            std::istringstream text(comment.substr(kOffset.size()));
            text >> head.offset.x() >> head.offset.y() >> head.offset.z();
        } else if (comment.starts_with(kSource)) {
            head.total = std::stoull(comment.substr(kSource.size()));
        }
    }
    return head;
}

}  // namespace lpf

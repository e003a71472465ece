#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "api/codec/format.h"
#include "api/codec/ply_header.h"
#include "core/shape/point_source.h"

namespace lpf {

/// The points of a PLY file, read where they lie, so that a file may be larger than memory.
class PlyPoints final : public PointSource {
public:
    /// Opens a little-endian file of points alone, all rows of one length, positions in float32 or
    /// float64.
    /// @param file must outlive the points
    /// @param let_go told when what has been read may leave the memory
    /// @returns nothing for a file of any other kind
    /// @throws as decode_ply, for what the header says
    [[nodiscard]] static std::optional<PlyPoints> open(std::span<const std::byte> file,
                                                       const DecodeLimits& limits,
                                                       std::function<void()> let_go = {});

    [[nodiscard]] const PlyHeader& header() const { return header_; }
    [[nodiscard]] const PlyElement& vertices() const;
    [[nodiscard]] std::size_t row_bytes() const { return row_bytes_; }
    [[nodiscard]] std::span<const std::byte> row(std::size_t i) const {
        return file_.subspan(header_.bytes + i * row_bytes_, row_bytes_);
    }

    [[nodiscard]] Eigen::Vector3d position(std::size_t i) const;

    /// Writes a position into a row of this file, rounded to its types. @returns what it holds now
    Eigen::Vector3d put(const Eigen::Vector3d& position, std::span<std::byte> row) const;

    [[nodiscard]] std::size_t size() const override;
    void read(std::size_t begin, Points& points) const override;
    void read(std::span<const std::uint32_t> indices, Points& points) const override;
    void let_go() const override {
        if (let_go_) let_go_();
    }

private:
    struct Coordinate {
        std::size_t offset = 0;  // in a row
        bool is_double = false;
    };

    std::span<const std::byte> file_;
    PlyHeader header_;
    std::size_t row_bytes_ = 0;
    std::array<Coordinate, 3> coordinates_;
    std::function<void()> let_go_;
};

/// A document of the first rows alone, with all their attributes.
[[nodiscard]] Document first_rows(const PlyPoints& points, std::size_t rows,
                                  const DecodeLimits& limits);

/// What was written of a cloud.
struct WrittenPoints {
    std::uint64_t points = 0;
    Eigen::Vector3d minimum = {0, 0, 0};
    Eigen::Vector3d maximum = {0, 0, 0};
};

/// Writes a file again, row by row, with its points moved. Those that are not finite are left out.
/// @param moves of each point  @param finite how many points are finite
/// @param comment goes before those of the file  @param write takes the bytes in order
/// @throws Error{Cancelled}, and what `write` throws
WrittenPoints write_moved(const PlyPoints& points, std::span<const Eigen::Vector3f> moves,
                          std::uint64_t finite, const std::string& comment,
                          const std::function<void(std::string_view)>& write,
                          const Execution& execution);

}  // namespace lpf

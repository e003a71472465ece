#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/shape/point_cloud.h"

namespace lpf {

/// A cloud that is read part by part, so that it needs not be in memory as a whole.
class PointSource {
public:
    virtual ~PointSource() = default;

    [[nodiscard]] virtual std::size_t size() const = 0;

    /// Positions of the points from `begin` on, as many as `points` has columns. They need not be
    /// finite. May be called from any number of threads.
    virtual void read(std::size_t begin, Points& points) const = 0;

    /// Positions of the points with these indices, which ascend. @param points out, 3 x K
    virtual void read(std::span<const std::uint32_t> indices, Points& points) const = 0;

    /// What has been read so far may leave the memory.
    virtual void let_go() const {}
};

/// A cloud that is in memory.
class PointsInMemory final : public PointSource {
public:
    /// @param points must outlive the source
    explicit PointsInMemory(const Points& points) : points_(points) {}

    [[nodiscard]] std::size_t size() const override {
        return static_cast<std::size_t>(points_.cols());
    }
    void read(std::size_t begin, Points& points) const override {
        points = points_.middleCols(static_cast<Eigen::Index>(begin), points.cols());
    }
    void read(std::span<const std::uint32_t> indices, Points& points) const override {
        points.resize(3, static_cast<Eigen::Index>(indices.size()));
        for (std::size_t i = 0; i < indices.size(); ++i) {
            points.col(static_cast<Eigen::Index>(i)) = points_.col(indices[i]);
        }
    }

private:
    const Points& points_;
};

}  // namespace lpf

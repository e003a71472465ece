#pragma once

#include <functional>
#include <vector>

#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf::paper {

/// The distances of points to the exact shape, measured once; of more than 400 000 points, those of
/// every k-th.
class Errors {
public:
    Errors(const Points& points, const test::TestShape& shape);

    [[nodiscard]] test::ErrorStats all() const { return test::summarize(distances_); }
    [[nodiscard]] double rmse() const { return all().rmse; }

    /// RMSE of the points whose index is chosen; 0 if none is.
    [[nodiscard]] double rmse_of(const std::function<bool(Eigen::Index)>& chosen) const;

private:
    Eigen::Index step_;
    std::vector<double> distances_;
};

/// Every k-th point, so that at most `most` are left.
[[nodiscard]] Points thinned(const Points& points, Eigen::Index most);

}  // namespace lpf::paper

#include "tests/paper/errors.h"

namespace lpf::paper {
namespace {

constexpr Eigen::Index kMostMeasured = 400'000;

Eigen::Index step_for(Eigen::Index count, Eigen::Index most) { return 1 + (count - 1) / most; }

}  // namespace

Points thinned(const Points& points, Eigen::Index most) {
    const Eigen::Index step = points.cols() > 0 ? step_for(points.cols(), most) : 1;
    if (step == 1) return points;
    return points(Eigen::all, Eigen::seq(0, points.cols() - 1, step));
}

Errors::Errors(const Points& points, const test::TestShape& shape)
    : step_(step_for(points.cols(), kMostMeasured)),
      distances_(
          test::distances_of(thinned(points, kMostMeasured),
                             [&](const test::Vector3d& point) { return shape.distance(point); })) {}

double Errors::rmse_of(const std::function<bool(Eigen::Index)>& chosen) const {
    std::vector<double> kept;
    for (std::size_t i = 0; i < distances_.size(); ++i) {
        if (chosen(step_ * static_cast<Eigen::Index>(i))) kept.push_back(distances_[i]);
    }
    return test::summarize(std::move(kept)).rmse;
}

}  // namespace lpf::paper

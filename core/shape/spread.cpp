#include "core/shape/spread.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/normal_equations.h"
#include "core/shape/quantile.h"

namespace lpf {
namespace {

/// Two sheets leave less than this share of the variance when they are told apart; an even block
/// leaves .25, noise alone .36, what a ball cuts out of noise .30.
constexpr double kTwoSheets = 0.23;
constexpr int kSplitRounds = 4;
constexpr double kFewestForTwo = 50;  // of fewer points, chance makes two groups

/// A set is a curve if its second extent, less the third, is a smaller share of the first.
constexpr double kCurve = 0.3;

constexpr std::size_t kMostInBall = 3000;

/// Of neighbours. Their heights differ by the median of a normal difference: a few pairs across
/// two sheets make no difference.
constexpr std::size_t kMostPairs = 96;
constexpr double kMedianDifference = 0.954;

/// A quadric takes up so many degrees of freedom; fewer points than these get a plane.
constexpr double kInQuadric = 6;
constexpr double kInPlane = 3;
constexpr double kFewestForQuadric = 14;

/// The kurtosis of n values of noise is too small by about this much over n.
constexpr double kKurtosisOfFew = 6.0;

/// The variance within two groups of heights, split where it is least (2-means from the mean).
double variance_of_two(const std::vector<double>& heights) {
    double split = 0.0;
    double within = 0.0;
    for (int round = 0; round < kSplitRounds; ++round) {
        double count[2] = {0, 0};
        double sum[2] = {0, 0};
        double squares = 0.0;
        for (const double h : heights) {
            count[h > split] += 1;
            sum[h > split] += h;
            squares += h * h;
        }
        if (count[0] == 0 || count[1] == 0) break;
        split = (sum[0] / count[0] + sum[1] / count[1]) / 2;
        within = (squares - sum[0] * sum[0] / count[0] - sum[1] * sum[1] / count[1]) /
                 (count[0] + count[1]);
    }
    return std::max(0.0, within);
}

double kurtosis_of(const std::vector<double>& heights) {
    double second = 0.0;
    double fourth = 0.0;
    for (const double h : heights) {
        second += h * h;
        fourth += h * h * h * h;
    }
    const auto n = static_cast<double>(heights.size());
    return second > 0 ? n * fourth / (second * second) + kKurtosisOfFew / n : 3.0;
}

double share_in_middle(const std::vector<double>& heights, double variance) {
    const double limit = Spread::kMiddle * Spread::kMiddle * variance;
    const auto is_in_middle = [&](double h) { return h * h < limit; };
    return static_cast<double>(std::ranges::count_if(heights, is_in_middle)) /
           static_cast<double>(heights.size());
}

/// The points of a ball in the frame of the plane that suits them best.
class OnPlane {
public:
    /// A large ball is thinned: a few thousand points say as much.
    explicit OnPlane(const NearPoints& ball) : ball_(ball), stride_(1 + ball.size / kMostInBall) {
        Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
        for_each([&](const Eigen::Vector3d& p) {
            mean_ += p;
            squares += p * p.transpose();
            ++count_;
        });
        mean_ /= count_;
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
        solver.computeDirect(squares / count_ - mean_ * mean_.transpose());
        axes_ = solver.eigenvectors().transpose();
        extents_ = solver.eigenvalues();
    }

    [[nodiscard]] double count() const { return count_; }

    [[nodiscard]] bool are_curve() const {
        return extents_[1] - extents_[0] < kCurve * (extents_[2] - extents_[0]);
    }

    /// Heights above the plane.
    void heights(std::vector<double>& heights) const {
        heights.clear();
        for_each([&](const Eigen::Vector3d& p) { heights.push_back(axes_.row(0) * (p - mean_)); });
    }

    /// Takes the quadric off that suits the heights best: also where a shape is round, what is left
    /// is noise.
    void take_off_quadric(std::vector<double>& heights) const {
        const auto each = [&](const auto& body) {
            auto height = heights.begin();
            for_each([&](const Eigen::Vector3d& p) {
                const Eigen::Vector3d q = axes_ * (p - mean_);
                const double u = q[1];
                const double v = q[2];
                body({1, u, v, u * u, u * v, v * v}, *height++);
            });
        };
        using Row = double[6];
        NormalEquations<6> equations;
        each([&](const Row& row, double height) { equations.add(row, {height}); });
        const Eigen::Matrix<double, 6, 1> quadric = equations.solve();
        each([&](const Row& row, double& height) {
            height -= quadric.dot(Eigen::Map<const Eigen::Matrix<double, 6, 1>>(row));
        });
    }

    /// Places on the plane.
    [[nodiscard]] std::vector<Eigen::Vector2d> places() const {
        std::vector<Eigen::Vector2d> places;
        for_each([&](const Eigen::Vector3d& p) {
            places.emplace_back((axes_ * (p - mean_)).tail<2>());
        });
        return places;
    }

private:
    template <typename Body>
    void for_each(const Body& body) const {
        for (std::size_t i = 0; i < ball_.size; i += stride_) {
            body(Eigen::Vector3d(ball_.x[i], ball_.y[i], ball_.z[i]));
        }
    }

    const NearPoints& ball_;
    std::size_t stride_;
    double count_ = 0.0;
    Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();
    Eigen::Matrix3d axes_;     // row 0: the normal
    Eigen::Vector3d extents_;  // variances along them
};

double mean_square(const std::vector<double>& heights) {
    double sum = 0.0;
    for (const double h : heights) sum += h * h;
    return sum / static_cast<double>(heights.size());
}

}  // namespace

Spread spread_in(const NearPoints& ball, std::vector<double>& heights) {
    const OnPlane points(ball);
    const double count = points.count();
    const bool is_quadric = count >= kFewestForQuadric;
    points.heights(heights);
    if (is_quadric) points.take_off_quadric(heights);
    const double freedom = std::max(1.0, count - (is_quadric ? kInQuadric : kInPlane));
    const double whole = mean_square(heights);
    const double parted = count < kFewestForTwo ? whole : variance_of_two(heights);
    const bool is_parted = parted < kTwoSheets * whole;
    return {.deviation = std::sqrt(count / freedom * (is_parted ? parted : whole)),
            .whole = std::sqrt(count / freedom * whole),
            .kurtosis = kurtosis_of(heights),
            .in_middle = share_in_middle(heights, whole),
            .freedom = freedom,
            .is_parted = is_parted,
            .is_curve = points.are_curve()};
}

double deviation_between_neighbours(const NearPoints& ball, std::vector<double>& heights) {
    const OnPlane points(ball);
    points.heights(heights);
    if (points.count() >= kFewestForQuadric) points.take_off_quadric(heights);
    const std::vector<Eigen::Vector2d> places = points.places();
    const std::size_t stride = 1 + places.size() / kMostPairs;
    std::vector<double> differences;
    for (std::size_t i = 0; i < places.size(); i += stride) {
        std::size_t nearest = i;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < places.size(); ++k) {
            const double squared = (places[k] - places[i]).squaredNorm();
            if (squared >= least || k == i) continue;
            least = squared;
            nearest = k;
        }
        differences.push_back(std::abs(heights[nearest] - heights[i]));
    }
    return median(differences) / kMedianDifference;
}

// A ball of radius R about a place of a surface holds a disk of area pi (R^2 - h^2) of what noise
// carries to the height h, so that the variance s^2 of the heights is sigma^2 (R^2 - 3 sigma^2) /
// (R^2 - sigma^2). This is solved for sigma, with R = 1.
double uncut(double deviation) {
    const double square = deviation * deviation;
    const double sum = 1 + square;
    return std::sqrt((sum - std::sqrt(std::max(0.0, sum * sum - 12 * square))) / 6);
}

}  // namespace lpf

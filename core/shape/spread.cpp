#include "core/shape/spread.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace lpf {
namespace {

/// Two sheets leave less than this share of the variance when they are told apart; an even block
/// leaves .25, noise alone .36, what a ball cuts out of noise .30.
constexpr double kTwoSheets = 0.23;
constexpr int kSplitRounds = 4;
constexpr double kFewestForTwo = 50;  // of fewer points, chance makes two groups

constexpr std::size_t kMostInBall = 3000;

/// A ball cuts off what noise carries beyond it: the spread in one of radius R is too small by
/// about this much times (spread / R)^2.
constexpr double kCutOff = 1.9;

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

}  // namespace

Spread spread_in(const NearPoints& ball, std::vector<double>& heights) {
    // A large ball is thinned: its covariance is as good from a few thousand points.
    const std::size_t stride = 1 + ball.size / kMostInBall;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double count = 0;
    for (std::size_t i = 0; i < ball.size; i += stride, ++count) {
        const Eigen::Vector3d p(ball.x[i], ball.y[i], ball.z[i]);
        mean += p;
        squares += p * p.transpose();
    }
    mean /= count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(squares / count - mean * mean.transpose());
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    const double offset = normal.dot(mean);
    heights.clear();
    for (std::size_t i = 0; i < ball.size; i += stride) {
        heights.push_back(normal.dot(Eigen::Vector3d(ball.x[i], ball.y[i], ball.z[i])) - offset);
    }
    // Three degrees of freedom went into the plane.
    const double unbiased = count / std::max(1.0, count - 3);
    const double whole = std::max(0.0, solver.eigenvalues()[0]);
    const double parted = count < kFewestForTwo ? whole : variance_of_two(heights);
    const bool is_parted = parted < kTwoSheets * whole;
    return {.deviation = std::sqrt(unbiased * (is_parted ? parted : whole)),
            .kurtosis = kurtosis_of(heights),
            .points = count,
            .is_parted = is_parted};
}

double uncut_deviation(const Spread& spread) {
    return spread.deviation * (1 + kCutOff * spread.deviation * spread.deviation);
}

}  // namespace lpf

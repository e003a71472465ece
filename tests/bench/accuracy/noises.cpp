#include "tests/bench/accuracy/noises.h"

#include <cmath>

#include "tests/bench/accuracy/denoised.h"
#include "tests/support/metrics.h"
#include "tests/support/noises.h"

namespace lpf::accuracy {
namespace {

constexpr double kNoise = 0.01;  // of the half diagonal
constexpr double kAim = 0.5;

struct Noisy {
    std::string noise;
    Points points;
};

/// Faces that lie along the axes would only be moved.
Points rounded_when_turned(const Points& exact, double step) {
    const Eigen::Matrix3d turn = some_turn();
    return turn.transpose() * test::rounded(turn * exact, step);
}

std::vector<Noisy> noisy_scans(const Points& exact) {
    const double sigma = kNoise * test::diagonal_of(exact) / 2;
    return {{"even", test::with_even_noise(exact, sigma)},
            {"rounded", rounded_when_turned(exact, std::sqrt(12.0) * sigma)},
            {"long tails", test::with_long_tails(exact, sigma)},
            {"along z", test::with_noise_along_z(exact, sigma)},
            {"uneven", test::with_uneven_noise(exact, sigma / 3).points}};
}

}  // namespace

Case other_noises() {
    return {"other-noises",
            "50 000 points, noise of other kinds: what is left of the distance to the shape",
            [](const Conditions& conditions) {
                std::vector<Figure> figures;
                for (const char* name : {"sphere", "cube", "fin", "curve_on_surface"}) {
                    const test::TestShape shape =
                        test::make_shape(name, {.points = 50000, .seed = conditions.seed});
                    for (const auto& [noise, points] : noisy_scans(shape.points)) {
                        const double before = test::error_to_shape(points, shape).rmse;
                        const Points result = denoised(points, conditions);
                        const double after = test::error_to_shape(result, shape).rmse;
                        figures.push_back({shape.name + ", " + noise, after / before, kAim});
                    }
                }
                return figures;
            }};
}

}  // namespace lpf::accuracy

#include "core/field/piece_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace lpf {
namespace {

constexpr float kExtent = 1.1F;
constexpr float kNoise = 0.05F;

class Curve {
public:
    /// Points along the x axis, with noise across it.
    explicit Curve(int points) {
        target_.reserve(4 * static_cast<std::size_t>(points));
        for (int i = 0; i < points; ++i) add(uniform(), kNoise * normal(), kNoise * normal());
    }

    /// Another curve that passes the first at an acute angle, nearly one with it from 0.1 to 0.6.
    void cross(int points) {
        for (int i = 0; i < points; ++i) {
            const float along = 0.5F + 0.25F * uniform();
            add(along, 0.3F * (along - 0.2F) + kNoise * normal(), kNoise * normal());
        }
    }

    /// @returns the curve that is fitted to all
    Piece fitted() {
        sample_.assign(target_, 100000, kExtent, 2.0F, kExtent);
        Piece piece;
        piece.dimension = kCurve;
        piece.noise = kNoise;
        piece.reach = 6 * kNoise;
        sample_.look_along(piece, sample_.size());
        sample_.measure(piece, sample_.size());
        fit_smooth(sample_, sample_.size(), piece);
        sample_.measure(piece, sample_.size());
        estimate_error(sample_, piece);
        return piece;
    }

private:
    float uniform() { return static_cast<float>(random_.uniform(-1, 1)); }
    float normal() { return static_cast<float>(random_.normal()); }

    void add(float x, float y, float z) {
        target_.x[target_.size] = x;
        target_.y[target_.size] = y;
        target_.z[target_.size] = z;
        ++target_.size;
    }

    Random random_{5, 1};
    TargetArea target_;
    PieceSample sample_;
};

double farthest(const Piece& piece) {
    double most = 0;
    for (float x = -0.9F; x <= 0.9F; x += 0.1F) {
        most = std::max<double>(most, piece.shape(x, 0).norm());
    }
    return most;
}

TEST(PieceFit, OfACurveIsNotPulledByAnotherThatCrossesIt) {
    Curve curve(1400);
    const Piece alone = curve.fitted();
    curve.cross(700);
    const Piece crossed = curve.fitted();
    EXPECT_LT(farthest(alone), 0.25 * kNoise);
    EXPECT_LT(farthest(crossed), 0.5 * kNoise);
    EXPECT_LT(crossed.squared_bias, 4 * alone.squared_bias + 1e-2F * kNoise * kNoise);
}

TEST(PieceFit, OfACurveThatIsCrowdedAlongMostOfItUsesAll) {
    Curve curve(300);
    for (int i = 0; i < 3; ++i) curve.cross(1);
    EXPECT_LT(farthest(curve.fitted()), 0.5 * kNoise);
}

}  // namespace
}  // namespace lpf

#include "tests/support/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace lpf::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kOnSurface = 1e-9;

Vector3d on_unit_sphere(Random& random) {
    const double z = random.uniform(-1.0, 1.0);  // Archimedes: area is uniform in z
    const double angle = random.uniform(0.0, 2 * kPi);
    const double flat = std::sqrt(1.0 - z * z);
    return {flat * std::cos(angle), flat * std::sin(angle), z};
}

class Capsule final : public Solid {
public:
    Capsule(const Vector3d& from, const Vector3d& to, double radius)
        : from_(from), along_(to - from), radius_(radius) {}

    double area() const override { return 2 * kPi * radius_ * (along_.norm() + 2 * radius_); }
    Vector3d sample(Random& random) const override {
        const double length = along_.norm();
        if (random.uniform() * (length + 2 * radius_) < length) {
            const Vector3d side = along_.unitOrthogonal();
            const double angle = random.uniform(0.0, 2 * kPi);
            const Vector3d out = Eigen::AngleAxisd(angle, along_ / length) * side;
            return from_ + random.uniform() * along_ + radius_ * out;
        }
        const Vector3d out = on_unit_sphere(random);
        return (out.dot(along_) > 0 ? Vector3d(from_ + along_) : from_) + radius_ * out;
    }
    double signed_distance(const Vector3d& point) const override {
        const Vector3d d = point - from_;
        const double squared = along_.squaredNorm();
        const double t = squared > 0 ? std::clamp(d.dot(along_) / squared, 0.0, 1.0) : 0.0;
        return (d - t * along_).norm() - radius_;
    }
    Eigen::AlignedBox3d box() const override {
        const Vector3d around = Vector3d::Constant(radius_);
        const Vector3d to = from_ + along_;
        return {from_.cwiseMin(to) - around, from_.cwiseMax(to) + around};
    }

private:
    Vector3d from_, along_;
    double radius_;
};

class Block final : public Solid {
public:
    Block(const Vector3d& low, const Vector3d& high) : box_(low, high) {}

    double area() const override {
        const Vector3d s = box_.sizes();
        return 2 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
    }
    Vector3d sample(Random& random) const override {
        const Vector3d s = box_.sizes();
        const double yz = s.y() * s.z(), zx = s.z() * s.x(), xy = s.x() * s.y();
        const double choice = random.uniform() * (yz + zx + xy);
        const int axis = choice < yz ? 0 : choice < yz + zx ? 1 : 2;
        Vector3d place(random.uniform(), random.uniform(), random.uniform());
        place[axis] = place[axis] < 0.5 ? 0 : 1;
        return box_.min() + place.cwiseProduct(s);
    }
    double signed_distance(const Vector3d& point) const override {
        const Vector3d off = (point - box_.center()).cwiseAbs() - box_.sizes() / 2;
        return off.cwiseMax(0).norm() + std::min(0.0, off.maxCoeff());
    }
    Eigen::AlignedBox3d box() const override { return box_; }

private:
    Eigen::AlignedBox3d box_;
};

class Ring final : public Solid {
public:
    Ring(const Vector3d& centre, double circle, double radius)
        : centre_(centre), circle_(circle), radius_(radius) {}

    double area() const override { return 4 * kPi * kPi * circle_ * radius_; }
    Vector3d sample(Random& random) const override {
        const double around = random.uniform(0.0, 2 * kPi);
        double angle = 0, out = 0;
        do {  // the outer side of it has more area
            angle = random.uniform(0.0, 2 * kPi);
            out = circle_ + radius_ * std::cos(angle);
        } while (random.uniform() * (circle_ + radius_) > out);
        return centre_ +
               Vector3d(out * std::cos(around), out * std::sin(around), radius_ * std::sin(angle));
    }
    double signed_distance(const Vector3d& point) const override {
        const Vector3d d = point - centre_;
        return std::hypot(d.head<2>().norm() - circle_, d.z()) - radius_;
    }
    Eigen::AlignedBox3d box() const override {
        const Vector3d half(circle_ + radius_, circle_ + radius_, radius_);
        return {centre_ - half, centre_ + half};
    }

private:
    Vector3d centre_;
    double circle_, radius_;
};

class UnionSurface final : public Piece {
public:
    explicit UnionSurface(const std::vector<SolidPtr>& solids) : solids_(solids) {
        for (const SolidPtr& solid : solids_) {
            box_.extend(solid->box());
            area_up_to_.push_back((area_up_to_.empty() ? 0.0 : area_up_to_.back()) + solid->area());
        }
        constexpr int kTrials =
            100000;  // the share of what is not buried, to a third of a per cent
        Random random(1, 0x501d);
        int bare = 0;
        for (int i = 0; i < kTrials; ++i) bare += sample_of_any(random).has_value();
        measure_ = area_up_to_.back() * bare / kTrials;
    }

    int dimension() const override { return 2; }
    double measure() const override { return measure_; }
    Vector3d sample(Random& random) const override {
        std::optional<Vector3d> place;
        while (!place) place = sample_of_any(random);
        return *place;
    }
    double squared_distance(const Vector3d& point) const override {
        return std::pow(signed_distance(point), 2);
    }
    Eigen::AlignedBox3d box() const override { return box_; }

private:
    /// Of all solids by their area; nothing if it is buried in another, or part of one before.
    std::optional<Vector3d> sample_of_any(Random& random) const {
        const double choice = random.uniform() * area_up_to_.back();
        const auto at = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, choice);
        const auto chosen = static_cast<std::size_t>(at - area_up_to_.begin());
        const Vector3d place = solids_[chosen]->sample(random);
        for (std::size_t k = 0; k < solids_.size(); ++k) {
            const double least = k < chosen ? kOnSurface : -kOnSurface;
            if (k != chosen && solids_[k]->signed_distance(place) < least) return std::nullopt;
        }
        return place;
    }
    double signed_distance(const Vector3d& point) const {
        double nearest = solids_.front()->signed_distance(point);
        for (const SolidPtr& solid : solids_) {
            nearest = std::min(nearest, solid->signed_distance(point));
        }
        return nearest;
    }

    std::vector<SolidPtr> solids_;
    std::vector<double> area_up_to_;
    Eigen::AlignedBox3d box_;
    double measure_ = 0.0;
};

}  // namespace

SolidPtr ball(const Vector3d& centre, double radius) { return capsule(centre, centre, radius); }

SolidPtr capsule(const Vector3d& from, const Vector3d& to, double radius) {
    return std::make_shared<Capsule>(from, to, radius);
}

SolidPtr block(const Vector3d& low, const Vector3d& high) {
    return std::make_shared<Block>(low, high);
}

SolidPtr ring(const Vector3d& centre, double circle, double radius) {
    return std::make_shared<Ring>(centre, circle, radius);
}

PiecePtr union_surface(const std::vector<SolidPtr>& solids) {
    return std::make_shared<UnionSurface>(solids);
}

}  // namespace lpf::test

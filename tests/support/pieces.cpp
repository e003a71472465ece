#include "tests/support/pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lpf::test {
namespace {

class Rectangle final : public Piece {
public:
    Rectangle(const Vector3d& corner, const Vector3d& edge_u, const Vector3d& edge_v)
        : corner_(corner), u_(edge_u), v_(edge_v) {}

    int dimension() const override { return 2; }
    double measure() const override { return u_.cross(v_).norm(); }
    Vector3d sample(Random& random) const override {
        const double a = random.uniform();
        return corner_ + a * u_ + random.uniform() * v_;
    }
    double squared_distance(const Vector3d& point) const override {
        const Vector3d d = point - corner_;
        const double a = std::clamp(d.dot(u_) / u_.squaredNorm(), 0.0, 1.0);
        const double b = std::clamp(d.dot(v_) / v_.squaredNorm(), 0.0, 1.0);
        return (d - a * u_ - b * v_).squaredNorm();
    }
    Eigen::AlignedBox3d box() const override {
        Eigen::AlignedBox3d result(corner_);
        return result.extend(corner_ + u_).extend(corner_ + v_).extend(corner_ + u_ + v_);
    }

private:
    Vector3d corner_, u_, v_;
};

class Sphere final : public Piece {
public:
    Sphere(const Vector3d& centre, double radius) : centre_(centre), radius_(radius) {}

    int dimension() const override { return 2; }
    double measure() const override { return 4.0 * std::numbers::pi * radius_ * radius_; }
    Vector3d sample(Random& random) const override {
        const double z = random.uniform(-1.0, 1.0);  // Archimedes: area is uniform in z
        const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
        const double ring = std::sqrt(1.0 - z * z);
        return centre_ + radius_ * Vector3d(ring * std::cos(angle), ring * std::sin(angle), z);
    }
    double squared_distance(const Vector3d& point) const override {
        const double off = (point - centre_).norm() - radius_;
        return off * off;
    }
    Eigen::AlignedBox3d box() const override {
        const Vector3d half = Vector3d::Constant(radius_);
        return {centre_ - half, centre_ + half};
    }

private:
    Vector3d centre_;
    double radius_;
};

class Segment final : public Piece {
public:
    Segment(const Vector3d& from, const Vector3d& to) : from_(from), edge_(to - from) {}

    int dimension() const override { return 1; }
    double measure() const override { return edge_.norm(); }
    Vector3d sample(Random& random) const override { return from_ + random.uniform() * edge_; }
    double squared_distance(const Vector3d& point) const override {
        const Vector3d d = point - from_;
        const double a = std::clamp(d.dot(edge_) / edge_.squaredNorm(), 0.0, 1.0);
        return (d - a * edge_).squaredNorm();
    }
    Eigen::AlignedBox3d box() const override {
        return Eigen::AlignedBox3d(from_).extend(from_ + edge_);
    }

private:
    Vector3d from_, edge_;
};

class Curve final : public Piece {
public:
    Curve(std::function<Vector3d(double)> c, double begin, double end)
        : c_(std::move(c)), begin_(begin), step_((end - begin) / kParts) {
        std::vector<Eigen::AlignedBox3d> boxes;
        for (int i = 0; i <= kParts; ++i) {
            nodes_.push_back(c_(begin_ + i * step_));
            const double part =
                i ? (nodes_[static_cast<std::size_t>(i)] - nodes_[static_cast<std::size_t>(i) - 1])
                        .norm()
                  : 0.0;
            length_.push_back(i ? length_.back() + part : 0.0);
            box_.extend(nodes_.back());
            if (i) boxes.push_back(Eigen::AlignedBox3d(nodes_.back()).extend(*(nodes_.end() - 2)));
        }
        bvh_ = Bvh(boxes);
    }

    int dimension() const override { return 1; }
    double measure() const override { return length_.back(); }
    Vector3d sample(Random& random) const override {
        const double wanted = random.uniform() * length_.back();
        const auto next = std::upper_bound(length_.begin() + 1, length_.end() - 1, wanted);
        const double low = *(next - 1);
        const auto part = static_cast<double>(next - length_.begin() - 1);
        return c_(begin_ + step_ * (part + (wanted - low) / (*next - low)));
    }
    double squared_distance(const Vector3d& point) const override {
        const Bvh::Hit hit = bvh_.nearest(point, [&](std::uint32_t i) {
            return Segment(nodes_[i], nodes_[i + 1]).squared_distance(point);
        });
        return refine(point, hit.item);
    }
    Eigen::AlignedBox3d box() const override { return box_; }

private:
    static constexpr int kParts = 2048;

    /// Golden-section search over the part and its two neighbours.
    double refine(const Vector3d& point, std::uint32_t part) const {
        const double ratio = 1.0 / std::numbers::phi;
        const auto squared = [&](double t) { return (c_(t) - point).squaredNorm(); };
        double low = begin_ + step_ * std::max(0.0, part - 1.0);
        double high = begin_ + step_ * std::min<double>(kParts, part + 2.0);
        double best = std::min(squared(low), squared(high));
        double a = high - ratio * (high - low), at_a = squared(a);
        double b = low + ratio * (high - low), at_b = squared(b);
        for (int i = 0; i < 36; ++i) {
            if (at_a < at_b) {
                high = std::exchange(b, a);
                at_b = at_a;
                a = high - ratio * (high - low);
                at_a = squared(a);
            } else {
                low = std::exchange(a, b);
                at_a = at_b;
                b = low + ratio * (high - low);
                at_b = squared(b);
            }
            best = std::min({best, at_a, at_b});
        }
        return best;
    }

    std::function<Vector3d(double)> c_;
    double begin_, step_;
    std::vector<Vector3d> nodes_;
    std::vector<double> length_;  // up to each node
    Eigen::AlignedBox3d box_;
    Bvh bvh_;
};

}  // namespace

PiecePtr rectangle(const Vector3d& corner, const Vector3d& edge_u, const Vector3d& edge_v) {
    return std::make_shared<Rectangle>(corner, edge_u, edge_v);
}

PiecePtr sphere_surface(const Vector3d& centre, double radius) {
    return std::make_shared<Sphere>(centre, radius);
}

PiecePtr segment(const Vector3d& from, const Vector3d& to) {
    return std::make_shared<Segment>(from, to);
}

PiecePtr curve(std::function<Vector3d(double)> c, double begin, double end) {
    return std::make_shared<Curve>(std::move(c), begin, end);
}

}  // namespace lpf::test

#include <algorithm>
#include <cmath>

#include "tests/support/pieces.h"

namespace lpf::test {
namespace {

class Sheet final : public Piece {
public:
    explicit Sheet(const WavySheet& sheet) : sheet_(sheet), borders_(borders_of(sheet)) {
        std::vector<Eigen::AlignedBox3d> boxes;
        for (int i = 0; i < kLattice * kLattice; ++i) {
            nodes_.push_back(sheet_.at(node(i % kLattice), node(i / kLattice)));
            boxes.emplace_back(nodes_.back());
            box_.extend(nodes_.back());
        }
        bvh_ = Bvh(boxes);
        area_ = integrate_area();
    }

    int dimension() const override { return 2; }
    double measure() const override { return area_; }
    Vector3d sample(Random& random) const override {
        for (;;) {  // accept in proportion to the area element
            const double x = random.uniform(-sheet_.half, sheet_.half);
            const double y = random.uniform(-sheet_.half, sheet_.half);
            if (random.uniform() * steepest_element() <= area_element(x, y)) {
                return sheet_.at(x, y);
            }
        }
    }
    double squared_distance(const Vector3d& point) const override {
        const Bvh::Hit hit =
            bvh_.nearest(point, [&](std::uint32_t i) { return (nodes_[i] - point).squaredNorm(); });
        const Eigen::Vector2d foot = newton(point, nodes_[hit.item].head<2>());
        const bool inside = foot.cwiseAbs().maxCoeff() <= sheet_.half;
        double best = hit.squared_distance;
        if (inside) {
            const double squared = (sheet_.at(foot.x(), foot.y()) - point).squaredNorm();
            if (squared <= best) return squared;
        }
        for (const PiecePtr& border : borders_) {
            best = std::min(best, border->squared_distance(point));
        }
        return best;
    }
    Eigen::AlignedBox3d box() const override { return box_; }

private:
    static constexpr int kLattice = 192;

    double node(int i) const { return sheet_.half * (2.0 * i / (kLattice - 1) - 1.0); }

    Eigen::Vector2d gradient(double x, double y) const {
        const double ax = x / sheet_.wave_x, ay = y / sheet_.wave_y;
        return {sheet_.height / sheet_.wave_x * std::cos(ax) * std::cos(ay),
                -sheet_.height / sheet_.wave_y * std::sin(ax) * std::sin(ay)};
    }
    double area_element(double x, double y) const {
        return std::sqrt(1.0 + gradient(x, y).squaredNorm());
    }
    double steepest_element() const {
        return std::hypot(1.0, sheet_.height / sheet_.wave_x, sheet_.height / sheet_.wave_y);
    }

    /// Midpoint rule: exact to about 1e-6 for these waves.
    double integrate_area() const {
        constexpr int kCells = 512;
        const double cell = 2.0 * sheet_.half / kCells;
        double sum = 0.0;
        for (int i = 0; i < kCells * kCells; ++i) {
            sum += area_element(-sheet_.half + cell * (i % kCells + 0.5),
                                -sheet_.half + cell * (i / kCells + 0.5));
        }
        return sum * cell * cell;
    }

    /// Foot of the perpendicular: Newton on half the squared distance as a function of (x, y).
    Eigen::Vector2d newton(const Vector3d& point, Eigen::Vector2d at) const {
        for (int i = 0; i < 20; ++i) {
            const double z = sheet_.z(at.x(), at.y());
            const double off = z - point.z();
            const Eigen::Vector2d slope = gradient(at.x(), at.y());
            const double fxy = -sheet_.height / (sheet_.wave_x * sheet_.wave_y) *
                               std::cos(at.x() / sheet_.wave_x) * std::sin(at.y() / sheet_.wave_y);
            Eigen::Matrix2d hessian = Eigen::Matrix2d::Identity() + slope * slope.transpose();
            hessian(0, 0) -= off * z / (sheet_.wave_x * sheet_.wave_x);
            hessian(1, 1) -= off * z / (sheet_.wave_y * sheet_.wave_y);
            hessian(0, 1) += off * fxy;
            hessian(1, 0) += off * fxy;
            const Eigen::Vector2d descent = at - point.head<2>() + off * slope;
            const Eigen::Vector2d step = hessian.inverse() * descent;
            at -= step;
            if (!(step.squaredNorm() > 1e-24)) break;
        }
        return at;
    }

    WavySheet sheet_;
    std::vector<PiecePtr> borders_;
    std::vector<Vector3d> nodes_;
    Eigen::AlignedBox3d box_;
    Bvh bvh_;
    double area_ = 0.0;
};

}  // namespace

double WavySheet::z(double x, double y) const {
    return height * std::sin(x / wave_x) * std::cos(y / wave_y);
}

PiecePtr wavy_sheet(const WavySheet& sheet) { return std::make_shared<Sheet>(sheet); }

std::vector<PiecePtr> borders_of(const WavySheet& sheet) {
    std::vector<PiecePtr> borders;
    for (const double side : {-sheet.half, sheet.half}) {
        borders.push_back(
            curve([=](double t) { return sheet.at(t, side); }, -sheet.half, sheet.half));
        borders.push_back(
            curve([=](double t) { return sheet.at(side, t); }, -sheet.half, sheet.half));
    }
    return borders;
}

}  // namespace lpf::test

#include "tests/support/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace lpf::test {
namespace {

PiecePtr unit_sheet(double z) { return rectangle({-1, -1, z}, {2, 0, 0}, {0, 2, 0}); }

std::vector<PiecePtr> border_of_unit_sheet(double z) {
    return {segment({-1, -1, z}, {1, -1, z}), segment({1, -1, z}, {1, 1, z}),
            segment({1, 1, z}, {-1, 1, z}), segment({-1, 1, z}, {-1, -1, z})};
}

std::vector<PiecePtr> cube_faces(double half) {
    const double edge = 2 * half;
    const Vector3d low = Vector3d::Constant(-half);
    const Vector3d x(edge, 0, 0), y(0, edge, 0), z(0, 0, edge);
    return {rectangle(low, x, y),     rectangle(low + z, x, y), rectangle(low, y, z),
            rectangle(low + x, y, z), rectangle(low, z, x),     rectangle(low + y, z, x)};
}

std::vector<PiecePtr> cube_edges(double half) {
    std::vector<PiecePtr> edges;
    for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
            Vector3d from = Vector3d::Constant(-half);
            if (corner & 1) from[(axis + 1) % 3] = half;
            if (corner & 2) from[(axis + 2) % 3] = half;
            edges.push_back(segment(from, from + 2 * half * Vector3d::Unit(axis)));
        }
    }
    return edges;
}

}  // namespace

double distance_to_pieces(const std::vector<PiecePtr>& pieces, const Vector3d& point) {
    double best = std::numeric_limits<double>::infinity();
    for (const PiecePtr& piece : pieces) {
        if (piece->box().squaredExteriorDistance(point) >= best) continue;
        best = std::min(best, piece->squared_distance(point));
    }
    return std::sqrt(best);
}

TestShape sampled(TestShape shape, const Sampling& sampling, double curve_share,
                  const std::vector<double>& weights) {
    shape.clean = sample_pieces(shape.pieces, sampling.points, sampling.seed, curve_share, weights,
                                &shape.piece);
    shape.points = shape.clean;
    for (Eigen::Index i = 0; i < shape.points.cols(); ++i) {
        Random random(sampling.seed + 1, static_cast<std::uint64_t>(i));
        for (int c = 0; c < 3; ++c) shape.points(c, i) += sampling.noise * random.normal();
    }
    return shape;
}

double TestShape::distance(const Vector3d& point) const {
    return distance_to_pieces(pieces, point);
}

double TestShape::diagonal() const {
    Eigen::AlignedBox3d box;
    for (const PiecePtr& piece_here : pieces) box.extend(piece_here->box());
    return box.diagonal().norm();
}

std::vector<std::uint8_t> TestShape::on_curve() const {
    std::vector<std::uint8_t> flags;
    for (const std::uint32_t i : piece) flags.push_back(pieces[i]->dimension() == 1);
    return flags;
}

Points sample_pieces(const std::vector<PiecePtr>& pieces, std::size_t count, std::uint64_t seed,
                     double curve_share, const std::vector<double>& weights,
                     std::vector<std::uint32_t>* piece_of) {
    double total[3] = {0, 0, 0};  // by dimension
    const auto weight = [&](std::size_t i) {
        return pieces[i]->measure() * (weights.empty() ? 1.0 : weights[i]);
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) total[pieces[i]->dimension()] += weight(i);
    if (total[1] == 0) curve_share = 0;
    if (total[2] == 0) curve_share = 1;
    std::vector<double> upto;  // running share of the points
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const int d = pieces[i]->dimension();
        const double share = (d == 1 ? curve_share : 1 - curve_share) * weight(i) / total[d];
        upto.push_back((upto.empty() ? 0.0 : upto.back()) + share);
    }
    Points points(3, static_cast<Eigen::Index>(count));
    if (piece_of) piece_of->clear();
    for (std::size_t i = 0; i < count; ++i) {
        Random random(seed, i);
        const auto found = std::upper_bound(upto.begin(), upto.end() - 1, random.uniform());
        const auto which = static_cast<std::size_t>(found - upto.begin());
        points.col(static_cast<Eigen::Index>(i)) = pieces[which]->sample(random);
        if (piece_of) piece_of->push_back(static_cast<std::uint32_t>(which));
    }
    return points;
}

TestShape make_plane(const Sampling& sampling) {
    return sampled({"plane", {unit_sheet(0)}, border_of_unit_sheet(0)}, sampling);
}

TestShape make_sphere(const Sampling& sampling) {
    return sampled({"sphere", {sphere_surface(Vector3d::Zero(), 1)}}, sampling);
}

TestShape make_cube(const Sampling& sampling, double half) {
    return sampled({"cube", cube_faces(half), {}, {}, cube_edges(half)}, sampling);
}

TestShape make_thin_plate(const Sampling& sampling, double gap) {
    TestShape shape{"thin_plate", {unit_sheet(-gap / 2), unit_sheet(gap / 2)}};
    for (const double z : {-gap / 2, gap / 2}) {
        for (PiecePtr& border : border_of_unit_sheet(z)) shape.borders.push_back(border);
    }
    return sampled(std::move(shape), sampling);
}

TestShape make_fin(const Sampling& sampling, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vector3d arm(std::cos(angle), 0, std::sin(angle));
    const Vector3d start(0, -1, 0), along(0, 2, 0);
    TestShape shape{"fin", {rectangle(start, {1, 0, 0}, along), rectangle(start, arm, along)}};
    shape.edges = {segment(start, start + along)};
    return sampled(std::move(shape), sampling);
}

TestShape make_crossing_curves(const Sampling& sampling) {
    const auto parabola = [](double t) { return Vector3d(0.2 * t, t, 0.5 * t * t); };
    return sampled({"crossing_curves",
                    {segment({-1, 0, 0}, {1, 0, 0}), curve(parabola, -1, 1)},
                    {},
                    {{-1, 0, 0}, {1, 0, 0}, parabola(-1), parabola(1)}},
                   sampling);
}

TestShape make_curve_on_surface(const Sampling& sampling) {
    const auto arc = [](double t) { return Vector3d(1 - std::cos(t), 0, std::sin(t)); };
    const double quarter = std::numbers::pi / 2;
    return sampled({"curve_on_surface",
                    {unit_sheet(0), curve(arc, 0, quarter)},
                    border_of_unit_sheet(0),
                    {arc(quarter)}},
                   sampling);
}

TestShape make_cube_with_curve(const Sampling& sampling) {
    const auto wave = [](double t) {
        return Vector3d(t, 0.8 * std::sin(1.5 * t), 0.5 * std::cos(1.2 * t));
    };
    constexpr double kReach = 3.37;  // for a diagonal of 8.8
    TestShape shape{
        "cube_with_curve", cube_faces(2), {}, {wave(-kReach), wave(kReach)}, cube_edges(2)};
    shape.pieces.push_back(curve(wave, -kReach, kReach));
    return sampled(std::move(shape), sampling);
}

TestShape make_open_sheet(const Sampling& sampling) {
    const WavySheet sheet{.half = 2, .height = 0.3, .wave_x = 0.6, .wave_y = 0.8};
    return sampled({"open_sheet", {wavy_sheet(sheet)}, borders_of(sheet)}, sampling);
}

TestShape make_density_step(const Sampling& sampling) {
    const Vector3d edge_x(1, 0, 0), edge_y(0, 2, 0);
    TestShape shape{"density_step",
                    {rectangle({-1, -1, 0}, edge_x, edge_y), rectangle({0, -1, 0}, edge_x, edge_y)},
                    border_of_unit_sheet(0)};
    return sampled(std::move(shape), sampling, 0, {4, 1});
}

TestShape make_isolated_points(const Sampling& sampling) {
    TestShape shape = make_plane(sampling);
    shape.name = "isolated_points";
    shape.outlier.assign(sampling.points, 0);
    for (std::size_t i = 25; i < sampling.points; i += 50) {
        Random random(sampling.seed + 2, i);
        const double side = random.uniform() < 0.5 ? -1 : 1;
        const Vector3d at(random.uniform(-3, 3), random.uniform(-3, 3),
                          side * random.uniform(0.8, 4));
        shape.points.col(static_cast<Eigen::Index>(i)) = at;
        shape.clean.col(static_cast<Eigen::Index>(i)) = at;
        shape.outlier[i] = 1;
    }
    return shape;
}

TestShape make_line(const Sampling& sampling) {
    return sampled({"line", {segment({-1, 0, 0}, {1, 0, 0})}, {}, {{-1, 0, 0}, {1, 0, 0}}},
                   sampling);
}

TestShape make_circle(const Sampling& sampling) {
    const auto turn = [](double t) { return Vector3d(std::cos(t), std::sin(t), 0); };
    return sampled({"circle", {curve(turn, 0, 2 * std::numbers::pi)}}, sampling);
}

TestShape make_helix(const Sampling& sampling) {
    const auto turn = [](double t) {
        return Vector3d(std::cos(t), std::sin(t), t / (3 * std::numbers::pi));
    };
    const double end = 6 * std::numbers::pi;
    return sampled({"helix", {curve(turn, 0, end)}, {}, {turn(0), turn(end)}}, sampling);
}

TestShape make_curvenet(const Sampling& sampling) {
    const WavySheet sheet;
    TestShape shape{"curvenet", {wavy_sheet(sheet)}, borders_of(sheet)};
    const auto height = [](double u) {
        return 4.5 + 1.5 * std::cos(std::numbers::pi * u / 33.1) + 0.4 * std::sin(u);
    };
    const auto add_arch = [&](const std::function<Vector3d(double)>& arch) {
        shape.pieces.push_back(curve(arch, -sheet.half, sheet.half));
        shape.ends.push_back(arch(-sheet.half));
        shape.ends.push_back(arch(sheet.half));
    };
    for (const double offset : {-11.0, -4.0, 4.0, 11.0}) {
        add_arch([=](double u) { return Vector3d(u, offset, height(u)); });
        add_arch([=](double u) { return Vector3d(offset, u, height(u)); });
    }
    for (const double x : {-12.4, 12.4}) {
        for (const double y : {-12.4, 12.4}) {
            shape.pieces.push_back(segment(sheet.at(x, y), {x, y, 6}));
            shape.ends.push_back({x, y, 6});
        }
    }
    return sampled(std::move(shape), sampling, 0.1);
}

}  // namespace lpf::test

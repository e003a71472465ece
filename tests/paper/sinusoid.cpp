#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/field_set.h"
#include "tests/paper/experiments.h"
#include "tests/support/metrics.h"

namespace lpf::paper {
namespace {

constexpr double kHeight = 0.25;
constexpr double kWave = 0.32;  // z = kHeight sin(x / kWave): a period of about 2
constexpr double kRadius = 2.0;
constexpr int kFields = 100;

/// |mean of exp(i phase)|, weighted: 1 if all phases are the same, about .1 for 100 of any.
class Alignment {
public:
    void add(double phase, double weight) {
        sum_ += std::polar(weight, phase);
        weights_ += weight;
    }
    [[nodiscard]] double value() const { return std::abs(sum_) / std::max(weights_, 1e-12); }

private:
    std::complex<double> sum_ = 0;
    double weights_ = 0;
};

/// Whether the seeds lie at the same places of the wave.
double alignment_of_places(const AnalysisResult& state) {
    Alignment places;
    for (const Frame& frame : state.frames) places.add(frame.seed().x() / kWave, 1);
    return places.value();
}

/// Whether the wave runs in the same direction of every frame, as far as its LPF uses the atom.
double alignment_of_frames(const AnalysisResult& state) {
    Alignment directions;
    for (std::size_t j = 0; j < state.frames.size(); ++j) {
        const Eigen::Matrix3d axes = state.frames[j].axes.cast<double>();
        const double angle = std::atan2(axes(0, 1), axes(0, 0));
        directions.add(2 * angle, std::abs(state.codes[j][0]));  // both senses are the same
    }
    return directions.value();
}

/// How much of the atom's height field one plane wave explains, at its best direction and length:
/// 1 for a pure sinusoid.
double share_of_a_wave(const Dictionary& dictionary) {
    const Pattern& pattern = dictionary.pattern();
    const float* z = dictionary.atom(0).data() + 2 * pattern.padded_size();
    const Eigen::VectorXd height =
        Eigen::Map<const Eigen::VectorXf>(z, pattern.size()).cast<double>();
    double best = 0.0;
    for (int turn = 0; turn < 90; ++turn) {
        const double angle = std::numbers::pi * turn / 90;
        for (double factor = 0.7; factor < 1.45; factor += 0.05) {
            Eigen::MatrixXd waves(pattern.size(), 3);
            for (int i = 0; i < pattern.size(); ++i) {
                const Eigen::Vector3f u = pattern.point(i);
                const double along = std::cos(angle) * u.x() + std::sin(angle) * u.y();
                const double phase = factor * kRadius / kWave * along;
                waves.row(i) << std::cos(phase), std::sin(phase), 1.0;
            }
            const Eigen::VectorXd fit = waves * waves.colPivHouseholderQr().solve(height);
            best = std::max(best, 1 - (height - fit).squaredNorm() / height.squaredNorm());
        }
    }
    return best;
}

/// Leaves a hundred LPFs, drawn at random.
void thin_out(FieldSet& fields, std::uint64_t random_seed) {
    const std::vector<std::size_t> chosen = fields.draw_sample(kFields, random_seed);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        fields.frames[i] = fields.frames[chosen[i]];
        fields.dimensions[i] = fields.dimensions[chosen[i]];
    }
    fields.frames.resize(chosen.size());
    fields.dimensions.resize(chosen.size());
}

/// Each target area moves along with its seed: the constraint that the LPFs cover the shape is
/// relaxed, as the paper says for this figure.
void release(FieldSet& fields) {
    for (Frame& frame : fields.frames) {
        frame.centre = frame.seed();
        frame.origin.setZero();
    }
}

/// A mark on the surface for each LPF: at its seed, long in the direction of its first axis.
Points marks(const std::vector<Frame>& frames) {
    constexpr int kLong = 14, kWide = 4;
    constexpr double kStep = 0.045;
    Points result(3, static_cast<Eigen::Index>(frames.size()) * kLong * kWide);
    Eigen::Index next = 0;
    for (const Frame& frame : frames) {
        const Eigen::Matrix3d axes = frame.axes.cast<double>();
        for (int i = 0; i < kLong * kWide; ++i) {
            const double along = kStep * (i % kLong - 0.5 * (kLong - 1));
            const double across = kStep * (i / kLong - 0.5 * (kWide - 1));
            Eigen::Vector3d at = frame.seed() + along * axes.col(0) + across * axes.col(1);
            at.z() = kHeight * std::sin(at.x() / kWave) + 0.06;
            result.col(next++) = at;
        }
    }
    return result;
}

test::Scene scene_of(const TestShape& shape, const AnalysisResult& state, const std::string& label,
                     const test::View& view) {
    test::Scene scene = plain_scene(shape.points, label, view);
    const Points on_top = marks(state.frames);
    const Eigen::Index below = scene.points.cols();
    scene.points.conservativeResize(3, below + on_top.cols());
    scene.points.rightCols(on_top.cols()) = on_top;
    scene.normals.conservativeResize(3, scene.points.cols());
    scene.normals.rightCols(on_top.cols()).colwise() = Eigen::Vector3f(-0.4F, -0.4F, 0.8F);
    scene.colours.resize(static_cast<std::size_t>(scene.points.cols()),
                         test::Colour(0.14F, 0.36F, 0.56F));
    return scene;
}

}  // namespace

Section sinusoid(const Settings& settings) {
    Section section{
        .title = "Fig. 5: one atom on a sinusoidal surface",
        .paper =
            "Random points on a sinusoidal surface, 100 LPFs at random places in random "
            "orientation, one atom. Shown after 1, 10 and 99 iterations: the LPFs align at "
            "places that look alike, and the atom becomes a smooth sinusoid. Target areas "
            "may move for this figure alone.",
        .here =
            "60 000 points on z = .25 sin(x / .32) over 12 x 12, r = 2 (one period), M = 193, "
            "d = 1, lambda = .05, the paper's probing operator. An alignment is 1 when all are "
            "the same and about .1 when they are anything: of the places of the seeds along "
            "the wave, and of the direction of the wave in the frames, weighted by the use of "
            "the atom. `share of a wave` is how much of the atom one plane wave explains.",
        .tables = {{{"iteration", "energy per LPF", "alignment of places", "of frames",
                     "share of a wave"}}}};
    const test::WavySheet sheet{.half = 6, .height = kHeight, .wave_x = kWave, .wave_y = 1e9};
    const TestShape shape = test::sampled({"sinusoid", {wavy_sheet(sheet)}},
                                          {.points = settings.points(60000), .seed = 5});
    const Shape cloud = cloud_of(shape.points);
    AnalysisParams params{.radius = kRadius,
                          .principal_frames = false,
                          .atoms = 1,
                          .lambda = 0.05,
                          .iterations = 1,
                          .random_seed = 5};
    FieldSet fields(cloud, params, settings.execution);
    fields.optimise_poses(params.pose_iterations, settings.execution);
    thin_out(fields, params.random_seed);

    const test::View view{.azimuth = -75, .elevation = 40, .extent = 11};
    std::vector<test::Scene> scenes;
    for (int i = 1; i <= settings.runs(99); ++i) {
        release(fields);
        const AnalysisResult state = analyze(fields, params, settings.execution);
        params.initial_dictionary = state.dictionary;
        if (i != 1 && i != 10 && i != settings.runs(99)) continue;
        section.tables[0].rows.push_back({std::to_string(i), number(state.energy.back().learning),
                                          number(alignment_of_places(state), 2),
                                          number(alignment_of_frames(state), 2),
                                          number(share_of_a_wave(state.dictionary))});
        if (!settings.picture_folder.empty()) {
            scenes.push_back(scene_of(shape, state, "iteration " + std::to_string(i), view));
        }
    }
    const Table& table = section.tables[0];
    const std::string first = table.rows.front()[0].text, last = table.rows.back()[0].text;
    section.claims = {
        {"the energy falls", table.at(last, "energy per LPF") < table.at(first, "energy per LPF")},
        {"the LPFs align in their orientation", table.at(last, "of frames") > 0.5},
        {"the LPFs align in their places", table.at(last, "alignment of places") > 0.5},
        {"the atom is a smooth sinusoid: one wave explains four fifths of it",
         table.at(last, "share of a wave") > 0.8}};
    add_picture(section, settings, "sinusoid",
                "The surface, and a mark at each seed, long in the direction of its first axis.",
                [&] {
                    return render_side_by_side(scenes, view, {1000, 280});
                });
    return section;
}

}  // namespace lpf::paper

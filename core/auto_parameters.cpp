#include "core/auto_parameters.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/base/error.h"

namespace lpf {
namespace {

/// Points in the ball of Measurements::density_radius.
constexpr double kPointsInDensityBall = 150.0;

/// An exact cloud is resampled as if it had this much noise [radius]: with none at all, LPFs would
/// not look for their pieces.
constexpr double kLeastNoise = 1e-6;

/// A radius of fewer sigma cuts the noise off; one of many more costs curves and thin parts.
constexpr double kSigmasInRadius = 3.0;

/// The ball of this share of the density radius (about 54 points) averages noise without losing
/// the shape; without noise, a smaller one (about 24 points) shows it better.
constexpr double kDensityShare = 0.6;
constexpr double kLeastDensityShare = 0.4;

/// Denoising goes on where more of the points than this are not on flat parts.
constexpr double kLeastBent = 0.12;

constexpr int kPatternPoints = 193;
constexpr int kFinePatternPoints = 793;
constexpr int kAtoms = 16;

std::string text(double value) {
    std::ostringstream out;
    out.precision(4);
    out << value;
    return out.str();
}

class Resolver {
public:
    Resolver(Task task, const Shape& shape, const Measurements& measured,
             const ParameterRequest& request)
        : task_(task), mesh_(shape.is_mesh() && task != Task::Denoise), m_(measured), q_(request) {}

    ResolvedParameters run() {
        AnalysisParams& a = result_.analysis;
        a.random_seed = q_.random_seed;
        a.debias = true;
        a.radius = choose("radius", q_.radius, auto_radius());
        noise_ratio_ = m_.noise / a.radius;
        // An analysis on its own is that of the paper; what moves points keeps to pieces of the
        // shape.
        const bool keeps_to_pieces = !mesh_ && task_ != Task::Analyze;
        if (keeps_to_pieces) {
            a.noise = m_.noise;
            a.noise_map = m_.noise_map;
        }
        a.adapt_radius = keeps_to_pieces && !q_.radius;
        a.probing = q_.probing.value_or(auto_probing());
        if (q_.dictionary) {
            a.initial_dictionary = q_.dictionary;
            a.keep_dictionary = q_.keep_dictionary;
        }
        a.pattern.points = choose("patternPoints", q_.pattern_points, auto_pattern_points());
        a.pattern.points = make_pattern_size(a.pattern.points);
        a.atoms = choose("atoms", q_.atoms, auto_atoms());
        a.lambda = choose("lambda", q_.lambda, auto_lambda());
        a.iterations =
            choose("analysisIterations", q_.analysis_iterations, auto_analysis_iterations());
        validate(a);
        if (task_ == Task::Denoise) resolve_denoise();
        if (task_ == Task::Resample) resolve_resample();
        warn();
        return std::move(result_);
    }

private:
    template <typename T>
    struct Choice {
        T value;
        std::string rule;
    };

    template <typename T>
    T choose(const char* name, const std::optional<T>& requested, Choice<T> automatic) {
        const T value = requested.value_or(automatic.value);
        result_.values.push_back({name, static_cast<double>(value), !requested.has_value(),
                                  requested ? "given by the user" : automatic.rule});
        return value;
    }

    [[nodiscard]] Choice<double> auto_radius() const {
        if (mesh_) {
            return {0.5 * m_.density_radius,
                    "half the radius that holds about 150 vertices of the mesh"};
        }
        const double share = kLeastDensityShare + (kDensityShare - kLeastDensityShare) *
                                                      std::min(1.0, 2 * m_.noise / m_.mean_spacing);
        const double by_density = share * m_.density_radius;
        const double by_noise = kSigmasInRadius * m_.noise;
        return {std::hypot(by_density, by_noise),
                "root of the sum of squares of " + text(share) +
                    " times the radius that holds about 150 points (" + text(m_.density_radius) +
                    ") and 3 times the noise (" + text(m_.noise) + ")"};
    }

    [[nodiscard]] ProbingKind auto_probing() const {
        if (mesh_) return ProbingKind::NearestTriangle;
        return ProbingKind::NoiseAware;
    }

    [[nodiscard]] Choice<int> auto_pattern_points() const {
        if (q_.dictionary) return {q_.dictionary->pattern().size(), "that of the dictionary"};
        if (mesh_) return {kFinePatternPoints, "a 32 x 32 grid, for the edges of meshes"};
        return {kPatternPoints, "a 16 x 16 grid, as in most experiments of the paper"};
    }

    [[nodiscard]] int make_pattern_size(int points) const {
        if (q_.dictionary) return points;
        return Pattern::grid(Pattern::grid_size_for(points)).size();
    }

    [[nodiscard]] Choice<int> auto_atoms() const {
        if (q_.dictionary) return {q_.dictionary->atoms(), "that of the dictionary"};
        return {kAtoms, "enough for most shapes, few enough to consolidate"};
    }

    /// In the convention of Eq. 2: twice the usual threshold of a LASSO with the factor 1/2.
    [[nodiscard]] Choice<double> auto_lambda() const {
        if (mesh_) return {0.002, "a mesh has no noise to suppress"};
        const double share = result_.analysis.radius / m_.density_radius;
        const double points_in_disk = kPointsInDensityBall * share * share;
        const double m = result_.analysis.pattern.points;
        const double lambda = 3.5 * noise_ratio_ * std::sqrt(m / std::max(points_in_disk, 1.0));
        return {std::max(lambda, 0.002),
                "3.5 (noise / radius) sqrt(patternPoints / points in a disk)"};
    }

    [[nodiscard]] Choice<int> auto_analysis_iterations() const {
        if (task_ == Task::Denoise) return {1, "more do not lower the error of denoising"};
        if (task_ == Task::Resample) return {2, "the energy hardly falls any more"};
        return {10, "as in the paper"};
    }

    void resolve_denoise() {
        DenoiseParams& d = result_.denoise;
        d.analysis = result_.analysis;
        d.iterations =
            choose("denoiseIterations", q_.denoise_iterations, auto_denoise_iterations());
        if (!q_.denoise_iterations) d.least_bent = kLeastBent;
        d.gamma = choose("gamma", q_.gamma, Choice<double>{0.0, "the full step (0 stands for it)"});
    }

    [[nodiscard]] static Choice<int> auto_denoise_iterations() {
        return {2,
                "at most: one removes the noise; a second follows where much of the shape is not "
                "flat within the reach of noise"};
    }

    void resolve_resample() {
        ResampleParams& r = result_.resample;
        const int targets =
            q_.target_spacing.has_value() + q_.target_points.has_value() + q_.factor.has_value();
        if (targets > 1) {
            throw Error(ErrorCode::InvalidParameter,
                        "Give one of targetSpacing, targetPoints and factor, not several.",
                        "targetSpacing");
        }
        r.analysis = result_.analysis;
        if (q_.target_spacing) {
            r.target_spacing = choose("targetSpacing", q_.target_spacing, {0.0, ""});
        } else if (q_.factor) {
            const double factor = choose("factor", q_.factor, {1.0, ""});
            r.target_points = static_cast<std::size_t>(
                std::max(3.0, std::round(factor * static_cast<double>(m_.points))));
        } else {
            r.target_points = choose("targetPoints", q_.target_points,
                                     {m_.points, "as many points as the input has"});
        }
        r.detail = mesh_ ? 1.0 : 0.0;
        if (mesh_) return;
        r.support = 1.5 * std::max(m_.mean_spacing, m_.density_radius / 12);
        r.denoise = DenoiseParams{};
        r.denoise->analysis = result_.analysis;
        r.denoise->analysis.iterations = 1;
        r.analysis.noise = std::max(kNoiseLeft * m_.noise, kLeastNoise * result_.analysis.radius);
        r.denoise->iterations = auto_denoise_iterations().value;
        r.denoise->least_bent = kLeastBent;
    }

    void warn() {
        const double r = result_.analysis.radius;
        if (r < 2 * m_.mean_spacing) {
            result_.warnings.push_back("The radius " + text(r) +
                                       " is less than two mean spacings (" + text(m_.mean_spacing) +
                                       "): most patterns see too few points to say anything.");
        }
        if (r > 0.25 * m_.diagonal) {
            result_.warnings.push_back("The radius " + text(r) +
                                       " is more than a quarter of the diagonal (" +
                                       text(m_.diagonal) + "): detail will be lost.");
        }
    }

    Task task_;
    bool mesh_;
    const Measurements& m_;
    const ParameterRequest& q_;
    double noise_ratio_ = 0.0;
    ResolvedParameters result_;
};

}  // namespace

ResolvedParameters resolve_parameters(Task task, const Shape& shape,
                                      const Measurements& measurements,
                                      const ParameterRequest& request) {
    return Resolver(task, shape, measurements, request).run();
}

}  // namespace lpf

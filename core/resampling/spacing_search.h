#pragma once

#include <algorithm>
#include <cmath>

namespace lpf {

/// Finds the tau_p that gives a number of points, by trying. Spacing first, then count: the number
/// of points falls with the square of the spacing on a surface, linearly on a curve; the exponent
/// is taken from the last two tries.
class SpacingSearch {
public:
    SpacingSearch(double first, double wanted) : spacing_(first), wanted_(wanted) {}

    [[nodiscard]] double spacing() const { return spacing_; }

    /// @returns whether `count` points at the current spacing are near enough to those wanted
    bool accepts(double count, double tolerance) {
        const double found = std::max(1.0, count);
        if (std::abs(found - wanted_) <= tolerance * wanted_) return true;
        if (last_count_ > 0 && found != last_count_) {
            exponent_ = std::clamp(
                std::log(found / last_count_) / std::log(last_spacing_ / spacing_), 0.7, 3.0);
        }
        last_spacing_ = spacing_;
        last_count_ = found;
        spacing_ *= std::pow(found / wanted_, 1 / exponent_);
        return false;
    }

private:
    double spacing_;
    double wanted_;
    double exponent_ = 2.0;
    double last_spacing_ = 0.0;
    double last_count_ = 0.0;
};

}  // namespace lpf

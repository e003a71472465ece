#include "core/shape/hidden_sheets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/shape/quantile.h"

namespace lpf {
namespace {

/// Sheets that add a smaller share to the variance cannot be told from the shape of chance.
constexpr double kLeastHidden = 0.4;
constexpr double kMostHidden = 0.8;

/// Chance parts flat noise in fewer of the balls.
constexpr double kPartedByChance = 0.35;

constexpr int kHalvings = 20;

/// The excess kurtosis of two points, and of an even distribution.
constexpr double kTwoPoints = -2.0;
constexpr double kEven = -1.2;

/// Which share of the variance has an excess kurtosis of its own, where Gaussian noise is the rest.
double share_with(double own, double excess) {
    return std::min(1.0, std::sqrt(std::max(0.0, excess / own)));
}

/// How much of two sheets with a share of the variance lies in the middle, as Spread counts it.
double middle_of_sheets(double share) {
    const double noise = std::sqrt(1 - share);
    const double density =
        std::exp(-share / (2 * noise * noise)) / (noise * std::sqrt(2 * std::numbers::pi));
    return 2 * Spread::kMiddle * density;
}

/// The same for an even distribution that Gaussian noise blurs.
double middle_of_even(double share) {
    const double half = std::sqrt(3 * share);  // its width
    const double reaches = std::sqrt(2 * std::max(1e-9, 1 - share));
    return 2 * Spread::kMiddle * std::erf(half / reaches) / (2 * half);
}

/// The share of two sheets that leave so much in the middle.
double share_of_sheets(double middle) {
    double low = 0.0;
    double high = kMostHidden;
    for (int i = 0; i < kHalvings; ++i) {
        const double share = (low + high) / 2;
        (middle_of_sheets(share) > middle ? low : high) = share;
    }
    return low;
}

double median_kurtosis(const std::vector<Spread>& spreads) {
    std::vector<double> values;
    values.reserve(spreads.size());
    for (const Spread& spread : spreads) values.push_back(spread.kurtosis);
    return median(values);
}

double share_parted(const std::vector<Spread>& spreads) {
    return static_cast<double>(std::ranges::count_if(spreads, &Spread::is_parted)) /
           static_cast<double>(spreads.size());
}

double mean_middle(const std::vector<Spread>& spreads) {
    double sum = 0.0;
    for (const Spread& spread : spreads) sum += spread.in_middle;
    return sum / static_cast<double>(spreads.size());
}

}  // namespace

HiddenSheets find_hidden_sheets(const std::vector<Spread>& spreads) {
    if (spreads.empty()) return {};
    HiddenSheets found;
    found.are_parted = share_parted(spreads) >= kPartedByChance;
    const double excess = median_kurtosis(spreads) - 3;
    const double share = share_with(kTwoPoints, excess);
    if (share < kLeastHidden) return found;
    const double middle = mean_middle(spreads);
    const double of_sheets = middle_of_sheets(std::min(share, kMostHidden));
    const double of_flat_noise = middle_of_even(share_with(kEven, excess));
    found.is_flat_noise = !found.are_parted && 2 * middle > of_sheets + of_flat_noise;
    if (found.is_flat_noise) return found;
    found.share = std::min(std::max(share, share_of_sheets(middle)), kMostHidden);
    return found;
}

}  // namespace lpf

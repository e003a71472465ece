#include "tests/core/uneven_noise.h"

#include <cmath>

#include "core/base/random.h"
#include "tests/support/metrics.h"

namespace lpf::test {

UnevenScan make_uneven(const TestShape& exact, double share) {
    const double least = share * diagonal_of(exact.points);
    const double low = exact.points.row(0).minCoeff();
    const double extent = exact.points.row(0).maxCoeff() - low;
    Random random(11);
    UnevenScan scan{exact.points, {}};
    for (auto point : scan.points.colwise()) {
        const double noise = least * std::pow(8.0, (point.x() - low) / extent);
        scan.noise.push_back(noise);
        point += noise * Vector3d(random.normal(), random.normal(), random.normal());
    }
    return scan;
}

}  // namespace lpf::test

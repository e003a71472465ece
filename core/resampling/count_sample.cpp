#include "core/resampling/count_sample.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/resampling/blocks.h"

namespace lpf {
namespace {

constexpr double kPartSide = 20.0;        // [tau_p]
constexpr double kPartSideInRadii = 1.6;  // LPFs that reach into a part lie in it or next to it
constexpr double kAround = 4.0;           // candidates around a part [tau_p]
constexpr double kParts = 128.0;          // at most,
constexpr double kFewestParts = 4.0;      // if there are as many,
constexpr double kPoints = 1e5;           // and else with as many points about

struct CellMembers {
    std::vector<std::uint32_t> fields;
    double area = 0.0;  // of their disks, in some unit
};
using MembersOfCells = std::map<Cell, CellMembers, CellsByRows>;

MembersOfCells members_of_cells(const FieldSet& fields, const CellLattice& lattice) {
    MembersOfCells members;
    for (std::uint32_t j = 0; j < fields.size(); ++j) {
        CellMembers& cell = members[lattice.cell_of(fields.frames[j].centre)];
        cell.fields.push_back(j);
        cell.area += fields.frames[j].radius * fields.frames[j].radius;
    }
    return members;
}

std::vector<std::uint32_t> members_around(const MembersOfCells& members, const Cell& cell) {
    std::vector<std::uint32_t> around;
    for_each_neighbour(cell, [&](const Cell& neighbour) {
        const auto found = members.find(neighbour);
        if (found == members.end()) return;
        around.insert(around.end(), found->second.fields.begin(), found->second.fields.end());
    });
    std::ranges::sort(around);
    return around;
}

}  // namespace

CountSample::CountSample(const FieldSet& fields, const Proposer& proposer, double spacing,
                         double points, const Execution& execution) {
    double largest = 0.0;
    for (const Frame& frame : fields.frames) largest = std::max(largest, frame.radius);
    const CellLattice lattice{fields.frames[fields.size() / 2].centre,
                              std::max(kPartSide * spacing, kPartSideInRadii * largest)};
    const MembersOfCells members = members_of_cells(fields, lattice);
    const auto cells = static_cast<double>(members.size());
    const double apart = std::min(std::max(cells / kParts, points / kPoints), cells / kFewestParts);
    const auto stride = static_cast<std::size_t>(std::max(1.0, std::ceil(apart)));
    double whole = 0.0;
    double parts = 0.0;
    std::vector<std::vector<std::uint32_t>> numbers;
    std::size_t i = stride / 2;
    for (const auto& [cell, of_cell] : members) {
        whole += of_cell.area;
        if (i++ % stride != 0) continue;
        parts += of_cell.area;
        const Eigen::AlignedBox3d space = lattice.space_of({cell, cell + Cell::Ones()});
        numbers.push_back(fields_near(fields.frames, members_around(members, cell),
                                      widened(space, kAround * spacing)));
        parts_.push_back({space, {}});
    }
    share_ = parts / whole;
    parallel_for(execution, "propose", "parts", parts_.size(), 1,
                 [&](std::size_t k, std::size_t, std::size_t) {
                     parts_[k].candidates = proposer.propose(
                         numbers[k], widened(parts_[k].space, kAround * spacing), {});
                 });
}

double CountSample::count(double spacing, const Execution& execution) const {
    std::vector<double> counts(parts_.size(), 0.0);
    parallel_for(execution, "consensus", "parts", parts_.size(), 1,
                 [&](std::size_t k, std::size_t, std::size_t) {
                     const Points points = find_consensus(parts_[k].candidates, spacing, {}).points;
                     for (const Eigen::Vector3d& point : points.colwise()) {
                         counts[k] += parts_[k].space.contains(point) ? 1.0 : 0.0;
                     }
                 });
    return std::accumulate(counts.begin(), counts.end(), 0.0) / share_;
}

}  // namespace lpf

#include "core/gathered_fields.h"

namespace lpf {
namespace {

/// Points that are kept, at most: two megabytes.
constexpr std::size_t kMostPoints = 1U << 17U;

}  // namespace

GatheredFields::GatheredFields(const FieldSet& set, std::span<const std::size_t> numbers)
    : set_(set), numbers_(numbers), begin_{0} {
    for (const std::size_t j : numbers) {
        set.gather_around(j, scratch_.target);
        if (points_.size + scratch_.target.size > kMostPoints) return;
        points_.append(scratch_.target, 0, scratch_.target.size);
        begin_.push_back(points_.size);
    }
}

void GatheredFields::probe(std::size_t i, float* field) {
    TargetArea& target = scratch_.target;
    if (i + 1 < begin_.size()) {
        target.size = 0;
        target.append(points_, begin_[i], begin_[i + 1] - begin_[i]);
    } else {
        set_.gather_around(numbers_[i], target);
    }
    set_.probe_gathered(numbers_[i], scratch_, field);
}

}  // namespace lpf

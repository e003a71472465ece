#include "tests/bench/accuracy/cases.h"

#include "tests/bench/accuracy/denoising.h"
#include "tests/bench/accuracy/noises.h"
#include "tests/bench/accuracy/resampling.h"

namespace lpf::accuracy {

std::vector<Case> cases() {
    std::vector<Case> all = denoising_cases();
    all.push_back(other_noises());
    all.push_back(resampling_case());
    return all;
}

}  // namespace lpf::accuracy

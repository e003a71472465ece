#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "api/codec/format.h"

namespace lpf {

/// What a file holds, without holding it: what an upload is told about, in little memory.
struct FileSummary {
    FileFormat format = FileFormat::PlyBinary;
    std::uint64_t points = 0;             ///< with finite coordinates
    std::uint64_t faces = 0;              ///< as the file counts them
    std::vector<Attribute> columns;       ///< of the points, without rows; lists have one offset
    Eigen::Vector3d minimum = {0, 0, 0};  ///< of the points, if there are any
    Eigen::Vector3d maximum = {0, 0, 0};
    Points sample;  ///< all points, or every second, third, ... so that they are not too many
    std::vector<Warning> warnings;

    [[nodiscard]] bool sample_is_whole() const {
        return static_cast<std::uint64_t>(sample.cols()) == points;
    }
};

struct SummaryOptions {
    std::size_t most_sampled = 500'000;

    /// Told how many bytes of the file are done with, so that their owner may take them out of
    /// memory.
    std::function<void(std::size_t)> passed = {};
};

/// Reads a file once from beginning to end and checks it as `decode` does: what is summarised can
/// be decoded. A file with faces or further elements and with points that are not finite is decoded
/// to see what is left of it.
/// @throws as decode
[[nodiscard]] FileSummary summarize(std::span<const std::byte> bytes, const DecodeLimits& limits,
                                    const SummaryOptions& options, const Execution& execution = {});

}  // namespace lpf

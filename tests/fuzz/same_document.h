#pragma once

#include "api/codec/document.h"

namespace lpf::fuzz {

enum class NanBits { Compared, AnyNan };  ///< text cannot tell one NaN from another

/// True if both say the same in points, attributes, faces, elements and header lines.
[[nodiscard]] bool same_document(const Document& a, const Document& b, NanBits nan_bits);

}  // namespace lpf::fuzz

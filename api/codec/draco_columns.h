#pragma once

#include <array>
#include <string_view>

namespace lpf {

/// Metadata that names what Draco has no place for.
inline constexpr const char* kDracoNameEntry = "name";         ///< of an attribute
inline constexpr const char* kDracoTypeEntry = "type";         ///< PLY type before widening
inline constexpr const char* kDracoCommentEntry = "comment";   ///< of the geometry, line by line
inline constexpr const char* kDracoObjInfoEntry = "obj_info";  ///< of the geometry, line by line

/// Columns that Draco's named attributes stand for, in the order of their components.
inline constexpr std::array<std::string_view, 3> kNormalColumns{"nx", "ny", "nz"};
inline constexpr std::array<std::string_view, 4> kColorColumns{"red", "green", "blue", "alpha"};
inline constexpr std::array<std::string_view, 2> kTexCoordColumns{"s", "t"};

}  // namespace lpf

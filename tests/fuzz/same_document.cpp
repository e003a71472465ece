#include "tests/fuzz/same_document.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lpf::fuzz {
namespace {

template <typename T>
bool same_floats(const std::vector<std::byte>& a, const std::vector<std::byte>& b) {
    for (std::size_t i = 0; i + sizeof(T) <= a.size(); i += sizeof(T)) {
        T left;
        T right;
        std::memcpy(&left, a.data() + i, sizeof left);
        std::memcpy(&right, b.data() + i, sizeof right);
        const bool both_nan = std::isnan(left) && std::isnan(right);
        if (!both_nan && std::memcmp(&left, &right, sizeof left) != 0) return false;
    }
    return true;
}

bool same_data(const Attribute& a, const Attribute& b, NanBits nan_bits) {
    if (a.data == b.data) return true;
    if (nan_bits == NanBits::Compared || a.data.size() != b.data.size()) return false;
    if (a.type == ScalarType::Float32) return same_floats<float>(a.data, b.data);
    if (a.type == ScalarType::Float64) return same_floats<double>(a.data, b.data);
    return false;
}

bool same_attribute(const Attribute& a, const Attribute& b, NanBits nan_bits) {
    const bool same_count = !a.is_list() || a.count_type == b.count_type;
    return a.name == b.name && a.type == b.type && a.list_offsets == b.list_offsets && same_count &&
           same_data(a, b, nan_bits);
}

bool same_attributes(const std::vector<Attribute>& a, const std::vector<Attribute>& b,
                     NanBits nan_bits) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](const Attribute& left, const Attribute& right) {
                          return same_attribute(left, right, nan_bits);
                      });
}

bool same_elements(const std::vector<Element>& a, const std::vector<Element>& b, NanBits nan_bits) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](const Element& left, const Element& right) {
                          return left.name == right.name && left.rows == right.rows &&
                                 same_attributes(left.attributes, right.attributes, nan_bits);
                      });
}

bool same_faces(const Document& a, const Document& b, NanBits nan_bits) {
    if (a.face_count() != b.face_count()) return false;
    if (a.face_count() == 0) return true;  // columns of no face are not kept
    return a.shape.triangles == b.shape.triangles && a.polygons.offsets == b.polygons.offsets &&
           a.polygons.vertices == b.polygons.vertices &&
           same_attributes(a.face_attributes, b.face_attributes, nan_bits);
}

}  // namespace

bool same_document(const Document& a, const Document& b, NanBits nan_bits) {
    return a.shape.cloud.points == b.shape.cloud.points &&
           same_attributes(a.shape.cloud.attributes, b.shape.cloud.attributes, nan_bits) &&
           same_faces(a, b, nan_bits) && same_elements(a.elements, b.elements, nan_bits) &&
           a.comments == b.comments && a.obj_info == b.obj_info;
}

}  // namespace lpf::fuzz

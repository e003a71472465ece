#include "api/codec/document.h"

#include <utility>

#include "api/codec/faces.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

void keep_elements_without_point_numbers(const Document& source, Document& result) {
    for (const Element& element : source.elements) {
        if (!refers_to_points(element)) {
            result.elements.push_back(element);
            continue;
        }
        result.warnings.push_back(
            {"element-dropped", message_of("element ", quoted(element.name),
                                           " refers to points of the input by number")});
    }
}

}  // namespace

Document with_points(const Document& source, PointCloud cloud, bool keeps_vertices) {
    if (keeps_vertices && cloud.size() != source.shape.size()) {
        fail(ErrorCode::Internal, "with_points: ", cloud.size(), " points cannot keep the ",
             source.shape.size(), " vertices of the document");
    }
    Document result;
    result.format = source.format;
    result.comments = source.comments;
    result.obj_info = source.obj_info;
    result.double_positions = source.double_positions;
    result.shape.cloud = std::move(cloud);
    if (keeps_vertices) {
        result.elements = source.elements;
        result.shape.triangles = source.shape.triangles;
        result.polygons = source.polygons;
        result.face_attributes = source.face_attributes;
        return result;
    }
    if (source.face_count() > 0) {
        result.warnings.push_back(
            {"faces-dropped", message_of("the ", source.face_count(),
                                         " faces of the input do not fit the new points")});
    }
    keep_elements_without_point_numbers(source, result);
    return result;
}

}  // namespace lpf

#include "api/attribute_plan.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "api/codec/faces.h"

namespace lpf {
namespace {

constexpr std::size_t kRows = 8;
constexpr std::array<const char*, 3> kNormals{"nx", "ny", "nz"};
constexpr std::string_view kVertex = "vertex";

/// As many rows as are asked for; from the start again where there are fewer.
std::vector<Attribute> first_rows(const std::vector<Attribute>& attributes, std::size_t rows) {
    std::vector<Attribute> result;
    for (const Attribute& attribute : attributes) {
        std::vector<std::uint32_t> numbers(attribute.rows() ? rows : 0);
        for (std::size_t i = 0; i < numbers.size(); ++i)
            numbers[i] = static_cast<std::uint32_t>(i % attribute.rows());
        result.push_back(gather(attribute, numbers));
    }
    return result;
}

/// Faces that use all of some points, the first with four corners if there are polygons.
Polygons strip_of(std::size_t points, bool polygons) {
    Polygons faces{{0}, {}};
    for (std::uint32_t i = 0; i + 2 < points; ++i) {
        faces.vertices.insert(faces.vertices.end(), {i, i + 1, i + 2});
        if (i == 0 && polygons) faces.vertices.push_back(3);
        faces.offsets.push_back(faces.vertices.size());
    }
    return faces;
}

/// A document of the same kind with a few points and faces, and one row of each element.
Document few_rows(const Document& document) {
    Document few;
    few.format = document.format;
    few.double_positions = document.double_positions;
    const std::size_t rows = std::min(kRows, document.shape.size());
    few.shape.cloud.points = document.shape.cloud.points.leftCols(static_cast<Eigen::Index>(rows));
    few.shape.cloud.attributes = first_rows(document.shape.cloud.attributes, rows);
    if (document.shape.is_mesh() && rows > 3) {
        const Polygons faces = strip_of(rows, !document.polygons.empty());
        few.shape.triangles = fans_of(faces, kRows);
        few.face_attributes = first_rows(document.face_attributes, faces.size());
        if (!document.polygons.empty()) few.polygons = faces;
    }
    for (const Element& element : document.elements)
        few.elements.push_back(
            {element.name, std::min<std::size_t>(1, element.rows),
             first_rows(element.attributes, std::min<std::size_t>(1, element.rows))});
    return few;
}

void set_floats(PointCloud& cloud, const std::string& name) {
    std::erase_if(cloud.attributes, [&](const Attribute& a) { return a.name == name; });
    const std::vector<float> values(cloud.size());
    cloud.attributes.push_back(float_attribute(name, values));
}

/// The points as the job will leave them.
PointCloud treated(const PointCloud& cloud, const JobInputs& inputs) {
    PointCloud result = cloud;
    if (inputs.outliers == OutlierPolicy::Mark) set_floats(result, "outlier");
    if (inputs.attributes == AttributePolicy::Drop) result.attributes.clear();
    const NormalPolicy normals = inputs.normals.value_or(NormalPolicy::Keep);
    for (const char* name : kNormals) {
        if (normals == NormalPolicy::Estimate) set_floats(result, name);
        if (normals == NormalPolicy::Drop)
            std::erase_if(result.attributes, [&](const Attribute& a) { return a.name == name; });
    }
    return result;
}

/// A result that was written and read again, and what was said about it.
struct Trial {
    Document result;
    std::vector<Warning> warnings;

    /// What was said about something of this name.
    [[nodiscard]] std::string reason(const std::string& name) const {
        for (const Warning& warning : warnings)
            if (warning.detail.find(name) != std::string::npos) return warning.detail;
        return {};
    }
};

Trial try_out(Task task, const Document& few, const JobInputs& inputs, int quantization_bits) {
    const bool keeps = task == Task::Denoise;
    Document made = with_points(few, treated(few.shape.cloud, inputs), keeps);
    Trial trial{{}, made.warnings};
    EncodeOptions options;
    options.format = result_format(inputs, few.format);
    options.double_positions = few.double_positions;
    options.quantization_bits = options.format == FileFormat::Draco ? quantization_bits : 0;
    const std::string bytes = encode(made, options, trial.warnings);
    DecodeLimits own;
    own.decode_helper.clear();
    trial.result = decode(std::as_bytes(std::span(bytes)), own);
    return trial;
}

const Attribute* find(const std::vector<Attribute>& attributes, const std::string& name) {
    const auto found = std::ranges::find(attributes, name, &Attribute::name);
    return found == attributes.end() ? nullptr : &*found;
}

bool is_normal(const std::string& name) {
    return std::ranges::find(kNormals, name) != kNormals.end();
}

/// How a plan is made for one task.
class Planner {
public:
    Planner(Task task, const Document& few, const JobInputs& inputs, int quantization_bits)
        : task_(task),
          few_(few),
          inputs_(inputs),
          bits_(quantization_bits),
          trial_(try_out(task, few, inputs, quantization_bits)) {}

    std::vector<AttributePlan> plan() {
        positions();
        for (const Attribute& attribute : few_.shape.cloud.attributes) of_points(attribute);
        for (const Attribute& attribute : trial_.result.shape.cloud.attributes) {
            if (!find(few_.shape.cloud.attributes, attribute.name))
                add(attribute.name, kVertex, Fate::Computed, made_by(attribute.name));
        }
        if (few_.shape.is_mesh()) faces();
        for (const Attribute& attribute : few_.face_attributes) of_faces(attribute);
        for (const Element& element : few_.elements) of_element(element);
        return std::move(plan_);
    }

private:
    void add(const std::string& name, std::string_view element, Fate fate, std::string detail) {
        plan_.push_back({name, std::string(element), fate, std::move(detail)});
    }

    void positions() {
        std::string detail = task_ == Task::Denoise
                                 ? "Every point moves to the consensus of the fields around it."
                                 : "New points from the consensus of the fields.";
        if (result_format(inputs_, few_.format) == FileFormat::Draco) {
            detail += bits_ == 0 ? " Written exactly (quantizationBits=0)."
                                 : " Quantised to " + std::to_string(bits_) +
                                       " bits along the longest side of the box.";
        } else {
            detail += few_.double_positions ? " Written as float64." : " Written as float32.";
        }
        add("position", kVertex, Fate::Computed, detail);
    }

    [[nodiscard]] static std::string made_by(const std::string& name) {
        if (is_normal(name)) return "Estimated on the result (normals=estimate).";
        if (name == "outlier") return "1 for isolated points (outliers=mark).";
        return "Made by the job.";
    }

    void of_points(const Attribute& attribute) {
        const std::string& name = attribute.name;
        const Attribute* left = find(trial_.result.shape.cloud.attributes, name);
        if (!left) return add(name, kVertex, Fate::Dropped, why_dropped(name));
        if (is_normal(name) && inputs_.normals == NormalPolicy::Estimate)
            return add(name, kVertex, Fate::Computed, made_by(name));
        std::string detail = task_ == Task::Denoise
                                 ? "Each point keeps its own value."
                                 : "Each new point gets the value of the nearest point.";
        if (left->type != attribute.type || left->is_list() != attribute.is_list())
            detail += " The format stores it as another type.";
        add(name, kVertex, task_ == Task::Denoise ? Fate::Kept : Fate::Carried, detail);
    }

    [[nodiscard]] std::string why_dropped(const std::string& name) const {
        if (is_normal(name) && inputs_.normals == NormalPolicy::Drop)
            return "As asked (normals=drop).";
        if (inputs_.attributes == AttributePolicy::Drop) return "As asked (attributes=drop).";
        const std::string reason = trial_.reason(name);
        return reason.empty() ? "The format of the result cannot hold it." : reason;
    }

    void faces() {
        if (!trial_.result.shape.is_mesh()) {
            return add("vertex_indices", "face", Fate::Dropped,
                       "The faces of the input do not fit the new points.");
        }
        const bool split = !few_.polygons.empty() && trial_.result.polygons.empty();
        add("vertex_indices", "face", Fate::Kept,
            split ? "Polygons are written as triangles: the format holds no others."
                  : "Faces stay between the same points.");
    }

    void of_faces(const Attribute& attribute) {
        if (find(trial_.result.face_attributes, attribute.name))
            return add(attribute.name, "face", Fate::Kept, "Each face keeps its own value.");
        const std::string reason = trial_.reason(attribute.name);
        add(attribute.name, "face", Fate::Dropped,
            !trial_.result.shape.is_mesh() ? "The faces are dropped, and so are their attributes."
            : reason.empty()               ? "The format of the result cannot hold it."
                                           : reason);
    }

    void of_element(const Element& element) {
        const auto& left = trial_.result.elements;
        const bool there = std::ranges::find(left, element.name, &Element::name) != left.end();
        const std::string reason = trial_.reason(element.name);
        add(element.name, element.name, there ? Fate::Kept : Fate::Dropped,
            there            ? "Kept as it is."
            : reason.empty() ? "The format of the result cannot hold it."
                             : reason);
    }

    Task task_;
    const Document& few_;
    const JobInputs& inputs_;
    int bits_;
    Trial trial_;
    std::vector<AttributePlan> plan_;
};

std::vector<AttributePlan> unused(const Document& document) {
    const std::string why = "An analysis makes no points; the file itself stays as it is.";
    std::vector<AttributePlan> plan{{"position", "vertex", Fate::Unused, why}};
    for (const Attribute& attribute : document.shape.cloud.attributes)
        plan.push_back({attribute.name, "vertex", Fate::Unused, why});
    return plan;
}

}  // namespace

std::string_view fate_name(Fate fate) {
    constexpr std::array<std::string_view, 5> kNames{"kept", "carried", "computed", "dropped",
                                                     "unused"};
    return kNames[static_cast<std::size_t>(fate)];
}

FileFormat result_format(const JobInputs& inputs, FileFormat of_input) {
    if (inputs.format) return *inputs.format;
    return of_input == FileFormat::PlyBigEndian ? FileFormat::PlyBinary : of_input;
}

std::vector<AttributePlan> plan_attributes(Task task, const Document& document,
                                           const JobInputs& inputs, int quantization_bits) {
    if (task == Task::Analyze) return unused(document);
    const Document few = few_rows(document);
    return Planner(task, few, inputs, quantization_bits).plan();
}

nlohmann::json to_json(const std::vector<AttributePlan>& plan) {
    nlohmann::json entries = nlohmann::json::array();
    for (const AttributePlan& entry : plan) {
        entries.push_back({{"name", entry.name},
                           {"element", entry.element},
                           {"plan", fate_name(entry.fate)},
                           {"detail", entry.detail}});
    }
    return entries;
}

}  // namespace lpf

#include "api/input_binding.h"

#include <algorithm>
#include <type_traits>

#include "api/choices.h"

namespace lpf {
namespace {

template <typename T>
InputValue to_value(const T& value) {
    if constexpr (std::is_enum_v<T>) {
        return std::string(choice_name(value));
    } else {
        return value;
    }
}

template <typename T>
std::optional<T> from_value(const InputValue& value) {
    if constexpr (std::is_enum_v<T>) {
        return choice_from_name<T>(std::get<std::string>(value));
    } else {
        return std::get<T>(value);
    }
}

template <auto Member>
constexpr InputBinding bind(std::string_view name) {
    using Optional = std::remove_cvref_t<decltype(std::declval<JobInputs>().*Member)>;
    return {name,
            [](const JobInputs& inputs) -> std::optional<InputValue> {
                if (!(inputs.*Member)) return std::nullopt;
                return to_value(*(inputs.*Member));
            },
            [](JobInputs& inputs, const InputValue& value) {
                inputs.*Member = from_value<typename Optional::value_type>(value);
            }};
}

constexpr InputBinding kBindings[] = {
    bind<&JobInputs::radius>("radius"),
    bind<&JobInputs::radius_unit>("radiusUnit"),
    bind<&JobInputs::pattern_points>("patternPoints"),
    bind<&JobInputs::atoms>("atoms"),
    bind<&JobInputs::lambda>("lambda"),
    bind<&JobInputs::analysis_iterations>("analysisIterations"),
    bind<&JobInputs::denoise_iterations>("denoiseIterations"),
    bind<&JobInputs::gamma>("gamma"),
    bind<&JobInputs::target_spacing>("targetSpacing"),
    bind<&JobInputs::target_points>("targetPoints"),
    bind<&JobInputs::factor>("factor"),
    bind<&JobInputs::outliers>("outliers"),
    bind<&JobInputs::duplicates>("duplicates"),
    bind<&JobInputs::attributes>("attributes"),
    bind<&JobInputs::normals>("normals"),
    bind<&JobInputs::dictionary>("dictionary"),
    bind<&JobInputs::dictionary_mode>("dictionaryMode"),
    bind<&JobInputs::probing>("probing"),
    bind<&JobInputs::random_seed>("randomSeed"),
    bind<&JobInputs::format>("format"),
    bind<&JobInputs::quantization_bits>("quantizationBits"),
    bind<&JobInputs::max_seconds>("maxSeconds"),
};

}  // namespace

std::span<const InputBinding> input_bindings() { return kBindings; }

const InputBinding& binding_of(std::string_view name) {
    return *std::ranges::find(kBindings, name, &InputBinding::name);
}

}  // namespace lpf

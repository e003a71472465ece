#include "api/codec/ply_number.h"

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <string_view>

namespace lpf {
namespace {

/// "1.#QNAN", "-1.#IND", "1.#INF": what some old programs print. `at` stands on the '#'.
template <std::floating_point T>
bool finish_old_special(const char*& at, const char* end, T& value) {
    const std::string_view rest(at, static_cast<std::size_t>(end - at));
    for (const std::string_view word : {"#INF", "#QNAN", "#SNAN", "#IND"}) {
        if (!rest.starts_with(word)) continue;
        value = word == "#INF" ? std::copysign(std::numeric_limits<T>::infinity(), value)
                               : std::numeric_limits<T>::quiet_NaN();
        at += word.size();
        while (at < end && *at == '0') ++at;
        return true;
    }
    return false;
}

template <std::floating_point T>
bool parse_float(const char*& at, const char* end, T& value) {
    auto [stop, error] = std::from_chars(at, end, value);
    if (error == std::errc::result_out_of_range) {
        // Too large or too small for T: round to infinity or zero as a conversion would.
        long double wide = 0;
        const auto again = std::from_chars(at, end, wide);
        if (again.ec != std::errc()) return false;
        value = static_cast<T>(wide);
    } else if (error != std::errc()) {
        return false;
    }
    at = stop;
    return at == end || *at != '#' || finish_old_special(at, end, value);
}

/// An integer, or a decimal number without a fraction such as 255.0 or 1e3.
bool parse_integer(const char*& at, const char* end, double low, double high, std::int64_t& value) {
    const char* begin = at;
    const auto [stop, error] = std::from_chars(at, end, value);
    const bool goes_on = stop < end && (*stop == '.' || *stop == 'e' || *stop == 'E');
    if (error == std::errc() && !goes_on) {
        at = stop;
        const auto wide = static_cast<double>(value);
        return wide >= low && wide <= high;
    }
    if (error != std::errc() && error != std::errc::invalid_argument) return false;
    double number = 0;
    at = begin;
    if (!parse_float(at, end, number)) return false;
    if (!(number >= low && number <= high) || number != std::trunc(number)) return false;
    value = static_cast<std::int64_t>(number);
    return true;
}

template <typename T>
bool parse(const char*& at, const char* end, std::byte* out) {
    T value{};
    if constexpr (std::floating_point<T>) {
        if (!parse_float(at, end, value)) return false;
    } else {
        std::int64_t wide = 0;
        if (!parse_integer(at, end, std::numeric_limits<T>::min(), std::numeric_limits<T>::max(),
                           wide)) {
            return false;
        }
        value = static_cast<T>(wide);
    }
    std::memcpy(out, &value, sizeof value);
    return true;
}

}  // namespace

bool parse_number(ScalarType type, const char*& at, const char* end, std::byte* out) {
    if (at < end && *at == '+') {
        if (++at < end && *at == '-') return false;
    }
    switch (type) {
        case ScalarType::Int8: return parse<std::int8_t>(at, end, out);
        case ScalarType::UInt8: return parse<std::uint8_t>(at, end, out);
        case ScalarType::Int16: return parse<std::int16_t>(at, end, out);
        case ScalarType::UInt16: return parse<std::uint16_t>(at, end, out);
        case ScalarType::Int32: return parse<std::int32_t>(at, end, out);
        case ScalarType::UInt32: return parse<std::uint32_t>(at, end, out);
        case ScalarType::Float32: return parse<float>(at, end, out);
        case ScalarType::Float64: return parse<double>(at, end, out);
    }
    return false;
}

}  // namespace lpf

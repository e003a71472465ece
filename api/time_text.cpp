#include "api/time_text.h"

#include <array>
#include <chrono>
#include <cstdio>

namespace lpf {
namespace {

using std::chrono::days;
using std::chrono::milliseconds;
using std::chrono::sys_days;

/// Reads digits and marks from the front of a text.
class Reader {
public:
    explicit Reader(std::string_view text) : text_(text) {}

    [[nodiscard]] bool ok() const { return ok_; }
    [[nodiscard]] bool at_end() const { return text_.empty(); }
    [[nodiscard]] char peek() const { return text_.empty() ? '\0' : text_.front(); }

    int digits(std::size_t count) {
        int value = 0;
        for (std::size_t i = 0; i < count; ++i) value = value * 10 + digit();
        return value;
    }

    int digit() {
        const char c = take();
        if (c < '0' || c > '9') ok_ = false;
        return c - '0';
    }

    void expect(char lower, char upper) {
        const char c = take();
        if (c != lower && c != upper) ok_ = false;
    }

    char take() {
        if (text_.empty()) {
            ok_ = false;
            return '\0';
        }
        const char c = text_.front();
        text_.remove_prefix(1);
        return c;
    }

private:
    std::string_view text_;
    bool ok_ = true;
};

std::optional<std::int64_t> read_date(Reader& reader) {
    const int year = reader.digits(4);
    reader.expect('-', '-');
    const int month = reader.digits(2);
    reader.expect('-', '-');
    const int day = reader.digits(2);
    if (!reader.ok()) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok()) return std::nullopt;
    return milliseconds(sys_days(date).time_since_epoch()).count();
}

std::optional<std::int64_t> read_clock(Reader& reader) {
    const int hour = reader.digits(2);
    reader.expect(':', ':');
    const int minute = reader.digits(2);
    reader.expect(':', ':');
    const int second = reader.digits(2);
    std::int64_t fraction = 0;
    if (reader.peek() == '.') {
        reader.take();
        std::int64_t scale = 100;
        do {
            fraction += reader.digit() * scale;
            scale /= 10;
        } while (reader.ok() && reader.peek() >= '0' && reader.peek() <= '9');
    }
    if (!reader.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
    return ((hour * 60 + minute) * 60LL + second) * 1000 + fraction;
}

std::optional<std::int64_t> read_offset(Reader& reader) {
    const char sign = reader.take();
    if (sign == 'Z' || sign == 'z') return 0;
    if (sign != '+' && sign != '-') return std::nullopt;
    const int hour = reader.digits(2);
    reader.expect(':', ':');
    const int minute = reader.digits(2);
    if (!reader.ok() || hour > 23 || minute > 59) return std::nullopt;
    return (hour * 60 + minute) * 60'000LL * (sign == '-' ? -1 : 1);
}

}  // namespace

std::string to_rfc3339(UnixMillis time) {
    const std::chrono::sys_time<milliseconds> instant{milliseconds(time)};
    const auto midnight = std::chrono::floor<days>(instant);
    const std::chrono::year_month_day date(midnight);
    const std::chrono::hh_mm_ss clock(instant - midnight);
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%03dZ",
                  static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                  static_cast<unsigned>(date.day()), static_cast<int>(clock.hours().count()),
                  static_cast<int>(clock.minutes().count()),
                  static_cast<int>(clock.seconds().count()),
                  static_cast<int>(clock.subseconds().count()));
    return text.data();
}

std::optional<UnixMillis> from_rfc3339(std::string_view text) {
    Reader reader(text);
    const auto date = read_date(reader);
    reader.expect('T', 't');
    const auto clock = read_clock(reader);
    const auto offset = read_offset(reader);
    if (!reader.ok() || !reader.at_end() || !date || !clock || !offset) return std::nullopt;
    return *date + *clock - *offset;
}

}  // namespace lpf

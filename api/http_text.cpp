#include "api/http_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <vector>

namespace lpf {

std::string lower(std::string_view text) {
    std::string result(text);
    std::ranges::transform(result, result.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
}

std::string_view trim(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool has_control(std::string_view text) {
    return std::ranges::any_of(text, [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\t') || byte == 0x7f;
    });
}

namespace {

/// The parts between separators that stand outside of quoted strings, trimmed.
std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    bool quoted = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (quoted && text[i] == '\\')
            ++i;
        else if (text[i] == '"')
            quoted = !quoted;
        else if (text[i] == separator && !quoted) {
            parts.push_back(trim(text.substr(begin, i - begin)));
            begin = i + 1;
        }
    }
    parts.push_back(trim(text.substr(std::min(begin, text.size()))));
    return parts;
}

std::string unquote(std::string_view text) {
    if (text.size() < 2 || text.front() != '"' || text.back() != '"') return std::string(text);
    std::string result;
    for (std::size_t i = 1; i + 1 < text.size(); ++i) {
        if (text[i] == '\\' && i + 2 < text.size()) ++i;
        result += text[i];
    }
    return result;
}

/// The value of a preference in a Prefer header: "" if it has none, nothing if it is not there.
std::optional<std::string> preference(std::string_view header, std::string_view name) {
    for (const std::string_view entry : split(header, ',')) {
        const std::string_view token = split(entry, ';').front();
        const std::size_t equals = token.find('=');
        if (lower(trim(token.substr(0, equals))) != name) continue;
        if (equals == std::string_view::npos) return std::string();
        return unquote(trim(token.substr(equals + 1)));
    }
    return std::nullopt;
}

/// A quality of an Accept header in thousandths; nothing if it is malformed.
std::optional<int> quality(std::string_view text) {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
    if (error != std::errc{} || stop != end || !(value >= 0.0) || value > 1.0) return std::nullopt;
    return static_cast<int>(value * 1000.0 + 0.5);
}

/// One entry of an Accept header.
struct MediaRange {
    std::string type;  ///< lower case, perhaps with wildcards
    int thousandths = 1000;
};

std::optional<std::vector<MediaRange>> media_ranges(std::string_view accept) {
    std::vector<MediaRange> ranges;
    for (const std::string_view entry : split(accept, ',')) {
        if (entry.empty()) continue;
        const auto parts = split(entry, ';');
        MediaRange range{.type = lower(parts.front())};
        if (range.type.find('/') == std::string::npos) return std::nullopt;
        for (std::size_t i = 1; i < parts.size(); ++i) {
            if (!lower(parts[i]).starts_with("q=")) continue;
            const auto q = quality(parts[i].substr(2));
            if (!q) return std::nullopt;
            range.thousandths = *q;
        }
        ranges.push_back(std::move(range));
    }
    return ranges;
}

/// How exactly a range names an offer: 3 itself, 2 its kind ("text/*"), 1 anything, 0 not at all.
int precision(const MediaRange& range, std::string_view offer) {
    if (range.type == offer) return 3;
    if (range.type == "*/*") return 1;
    const bool any_subtype = range.type.ends_with("/*");
    const std::string_view kind = std::string_view(range.type).substr(0, range.type.size() - 1);
    return any_subtype && offer.starts_with(kind) ? 2 : 0;
}

/// The most exact range that fits the offer decides.
int quality_of(std::string_view offer, const std::vector<MediaRange>& ranges) {
    int best = 0;
    int result = 0;
    for (const MediaRange& range : ranges) {
        const int fit = precision(range, offer);
        if (fit <= best) continue;
        best = fit;
        result = range.thousandths;
    }
    return result;
}

std::string_view opaque(std::string_view etag) {
    return etag.starts_with("W/") ? etag.substr(2) : etag;
}

bool is_token_char(unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("!#$&+-.^_`|~").find(static_cast<char>(c)) != std::string_view::npos;
}

}  // namespace

std::optional<std::uint64_t> parse_number(std::string_view text) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc{} || stop != end) return std::nullopt;
    return value;
}

std::optional<std::uint64_t> prefer_wait(std::string_view header, std::uint64_t maximum) {
    const auto text = preference(header, "wait");
    if (!text || text->empty()) return std::nullopt;
    if (!std::ranges::all_of(*text, [](char c) { return c >= '0' && c <= '9'; })) {
        return std::nullopt;
    }
    return std::min(parse_number(*text).value_or(maximum), maximum);
}

bool prefers_async(std::string_view header) {
    return preference(header, "respond-async").has_value();
}

std::optional<std::size_t> best_offer(std::string_view accept,
                                      std::span<const std::string_view> offers) {
    if (offers.empty()) return std::nullopt;
    const auto ranges = media_ranges(accept);
    if (!ranges || ranges->empty()) return 0;
    std::optional<std::size_t> best;
    int best_quality = 0;
    for (std::size_t i = 0; i < offers.size(); ++i) {
        const int q = quality_of(offers[i], *ranges);
        if (q <= best_quality) continue;
        best_quality = q;
        best = i;
    }
    return best;
}

std::string bare_media_type(std::string_view content_type) {
    return lower(trim(content_type.substr(0, content_type.find(';'))));
}

std::optional<std::string> header_parameter(std::string_view header, std::string_view name) {
    const auto parts = split(header, ';');
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t equals = parts[i].find('=');
        if (equals == std::string_view::npos) continue;
        if (lower(trim(parts[i].substr(0, equals))) != lower(name)) continue;
        return unquote(trim(parts[i].substr(equals + 1)));
    }
    return std::nullopt;
}

std::optional<std::string> extended_value(std::string_view text) {
    constexpr std::string_view kCharset = "utf-8'";
    if (lower(text.substr(0, kCharset.size())) != kCharset) return std::nullopt;
    const std::size_t quote = text.find('\'', kCharset.size());  // a language may stand before it
    if (quote == std::string_view::npos) return std::nullopt;
    std::string result;
    for (std::size_t i = quote + 1; i < text.size(); ++i) {
        if (text[i] != '%') {
            result += text[i];
            continue;
        }
        unsigned value = 0;
        const std::string_view digits = text.substr(i + 1, 2);
        const char* end = digits.data() + digits.size();
        const auto [stop, error] = std::from_chars(digits.data(), end, value, 16);
        if (digits.size() < 2 || error != std::errc{} || stop != end) return std::nullopt;
        result += static_cast<char>(value);
        i += 2;
    }
    return result;
}

ByteRange parse_range(std::string_view header, std::uint64_t size) {
    constexpr std::string_view kUnit = "bytes=";
    const std::string text = lower(trim(header));
    if (!text.starts_with(kUnit)) return {};
    const std::string_view range = trim(std::string_view(text).substr(kUnit.size()));
    const std::size_t dash = range.find('-');
    if (dash == std::string_view::npos || range.find(',') != std::string_view::npos) return {};
    const std::string_view left = range.substr(0, dash);
    const std::string_view right = range.substr(dash + 1);
    const auto first = parse_number(left);
    const auto last = parse_number(right);
    if ((!left.empty() && !first) || (!right.empty() && !last) || (!first && !last)) return {};
    if (!first) {  // the last bytes of the file
        if (*last == 0 || size == 0) return {.kind = ByteRange::Kind::Unsatisfiable};
        return {
            .kind = ByteRange::Kind::Part, .first = size - std::min(*last, size), .last = size - 1};
    }
    if (last && *last < *first) return {};
    if (*first >= size) return {.kind = ByteRange::Kind::Unsatisfiable};
    return {.kind = ByteRange::Kind::Part,
            .first = *first,
            .last = std::min(last.value_or(size - 1), size - 1)};
}

std::string content_range(const ByteRange& range, std::uint64_t size) {
    const std::string total = "/" + std::to_string(size);
    if (range.kind == ByteRange::Kind::Unsatisfiable) return "bytes *" + total;
    return "bytes " + std::to_string(range.first) + "-" + std::to_string(range.last) + total;
}

bool etag_matches(std::string_view header, std::string_view etag, bool weak) {
    for (const std::string_view entry : split(header, ',')) {
        if (entry == "*") return true;
        if (entry.empty()) continue;
        if (weak ? opaque(entry) == opaque(etag) : entry == etag && !etag.starts_with("W/")) {
            return true;
        }
    }
    return false;
}

std::string content_disposition(std::string_view filename) {
    constexpr std::string_view kHex = "0123456789ABCDEF";
    std::string plain;
    std::string encoded;
    bool ascii = true;
    for (const char c : filename) {
        const auto byte = static_cast<unsigned char>(c);
        const bool unsafe = byte < 0x20 || byte == 0x7F || c == '"' || c == '\\' || c == '/';
        const char kept = unsafe ? '_' : c;
        ascii = ascii && byte < 0x80;
        plain += byte < 0x80 ? kept : '_';
        if (is_token_char(static_cast<unsigned char>(kept))) {
            encoded += kept;
        } else {
            encoded += '%';
            encoded += kHex[static_cast<unsigned char>(kept) >> 4];
            encoded += kHex[static_cast<unsigned char>(kept) & 15];
        }
    }
    std::string result = "attachment; filename=\"" + plain + "\"";
    if (!ascii) result += "; filename*=UTF-8''" + encoded;
    return result;
}

}  // namespace lpf

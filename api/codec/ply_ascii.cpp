#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include "api/codec/ply_columns.h"
#include "api/codec/ply_number.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

class AsciiReader {
public:
    AsciiReader(const PlyElement& element, std::size_t rows, const PlyPlace& place,
                const Execution& execution)
        : begin_(reinterpret_cast<const char*>(place.file.data())),
          end_(begin_ + place.file.size()),
          at_(begin_ + place.at),
          first_row_(place.row),
          element_rows_(element.count),
          execution_(execution),
          table_(table_for(element, rows)) {}

    PlyTable read() {
        for (PlyColumn& column : table_.columns) {
            if (!column.property().is_list) column.set_rows(table_.rows);
        }
        parallel_for(on_one_thread(execution_), kDecodePhase, "rows", table_.rows, kRowsPerStep,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         for (row_ = begin; row_ < end; ++row_) read_row();
                     });
        return std::move(table_);
    }

    [[nodiscard]] std::size_t at() const { return static_cast<std::size_t>(at_ - begin_); }

private:
    void read_row();
    void read_list(PlyColumn& column);
    void read_value(const PlyColumn& column, ScalarType type, std::byte* out);
    [[noreturn]] void fail_at_value(const PlyColumn& column, ScalarType type) const;
    template <typename... Parts>
    [[noreturn]] void wrong(const Parts&... parts) const;

    void skip_blanks() {
        while (at_ < end_ && is_blank(*at_)) ++at_;
    }
    [[nodiscard]] bool at_line_end() const { return at_ == end_ || is_line_end(*at_); }
    [[nodiscard]] std::size_t line_number() const;

    const char* begin_;
    const char* end_;
    const char* at_;
    std::size_t first_row_;
    std::uint64_t element_rows_;
    const Execution& execution_;
    PlyTable table_;
    std::size_t row_ = 0;
};

/// Counted only when a message needs it, so that reading need not count.
std::size_t AsciiReader::line_number() const {
    std::size_t line = 1;
    for (const char* c = begin_; c < at_; ++c) {
        if (*c == '\n' || (*c == '\r' && (c + 1 == end_ || c[1] != '\n'))) ++line;
    }
    return line;
}

template <typename... Parts>
void AsciiReader::wrong(const Parts&... parts) const {
    malformed("line ", line_number(), " (row ", first_row_ + row_, " of ", element_rows_,
              " of element ", quoted(table_.name), "): ", parts...);
}

void AsciiReader::read_row() {
    while (at_ < end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
    if (at_ == end_) wrong("the file ends before this row; it is truncated or promises too much");
    for (PlyColumn& column : table_.columns) {
        if (column.property().is_list) {
            read_list(column);
        } else {
            const ScalarType type = column.property().type;
            read_value(column, type, column.data().data() + row_ * size_of(type));
        }
    }
    skip_blanks();
    if (!at_line_end()) {
        wrong("more values than the ", table_.columns.size(),
              " properties of the header take; each row must be one line");
    }
}

void AsciiReader::read_value(const PlyColumn& column, ScalarType type, std::byte* out) {
    skip_blanks();
    const char* from = at_;
    const bool good = parse_number(type, at_, end_, out);
    if (good && (at_line_end() || is_blank(*at_))) return;
    at_ = from;
    fail_at_value(column, type);
}

void AsciiReader::fail_at_value(const PlyColumn& column, ScalarType type) const {
    if (at_line_end()) {
        wrong("the line ends before property ", quoted(column.property().name),
              at_ == end_ ? "; the file is truncated" : "; each row must be one line");
    }
    const char* stop = at_;
    while (stop < end_ && !is_blank(*stop) && !is_line_end(*stop)) ++stop;
    wrong(quoted(std::string_view(at_, static_cast<std::size_t>(stop - at_))),
          " is not a value of type ", ply_type_name(type), " for property ",
          quoted(column.property().name));
}

void AsciiReader::read_list(PlyColumn& column) {
    const PlyProperty& property = column.property();
    // Lengths are read as int32 so that a negative one can be told from a word that is no number.
    std::int32_t length = 0;
    std::array<std::byte, sizeof length> bytes{};
    const char* from = at_;
    read_value(column, ScalarType::Int32, bytes.data());
    std::memcpy(&length, bytes.data(), sizeof length);
    if (length < 0) wrong("the list ", quoted(property.name), " has the negative length ", length);
    if (static_cast<std::uint64_t>(length) > kMaxPlyListLength) {
        fail(ErrorCode::LimitExceeded, "line ", line_number(), ": the list ", quoted(property.name),
             " has ", length, " values; the limit is ", kMaxPlyListLength);
    }
    if (length >= kLongList) throw_if_cancelled(execution_);
    at_ = from;
    std::array<std::byte, 8> count{};
    read_value(column, property.count_type, count.data());

    const auto n = static_cast<std::size_t>(length);
    const std::size_t bytes_left = static_cast<std::size_t>(end_ - at_);
    if (bytes_left < 2 * n) {
        wrong("the list ", quoted(property.name), " claims ", n, " values, but only ", bytes_left,
              " bytes are left in the file");
    }
    std::byte* out = column.add_list(n, table_.rows, bytes_left / 2);
    for (std::size_t i = 0; i < n; ++i) {
        read_value(column, property.type, out + i * size_of(property.type));
    }
}

}  // namespace

PlyTable read_ascii_rows(const PlyElement& element, std::size_t rows, PlyPlace& place,
                         const Execution& execution) {
    AsciiReader reader(element, rows, place, execution);
    PlyTable table = reader.read();
    place.at = reader.at();
    place.row += rows;
    return table;
}

}  // namespace lpf

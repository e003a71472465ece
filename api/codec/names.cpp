#include "api/codec/names.h"

#include <algorithm>

namespace lpf {

std::string NameSet::claim(std::string_view wanted) {
    std::string name(wanted.empty() ? std::string_view("unnamed") : wanted);
    const auto unsafe = [](char c) { return static_cast<unsigned char>(c) <= 0x20 || c == 0x7f; };
    std::replace_if(name.begin(), name.end(), unsafe, '_');
    const std::string base = name;
    for (int i = 2; !taken_.insert(name).second; ++i) name = base + "_" + std::to_string(i);
    return name;
}

std::string one_line(std::string_view text) {
    std::string line(text);
    const auto breaks = [](char c) { return c == '\n' || c == '\r' || c == '\0'; };
    std::replace_if(line.begin(), line.end(), breaks, ' ');
    return line;
}

}  // namespace lpf

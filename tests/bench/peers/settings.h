#pragma once

#include <map>
#include <stdexcept>
#include <string>

namespace lpf::peers {

/// The name=value arguments of a command line: each must be given, and is a number.
class Settings {
public:
    Settings(int argc, char** argv, int first) {
        for (int i = first; i < argc; ++i) {
            const std::string argument = argv[i];
            const auto equals = argument.find('=');
            if (equals == std::string::npos) {
                throw std::invalid_argument("'" + argument + "' is not NAME=NUMBER");
            }
            values_[argument.substr(0, equals)] = std::stod(argument.substr(equals + 1));
        }
    }

    [[nodiscard]] double number(const std::string& name) const {
        const auto found = values_.find(name);
        if (found == values_.end()) throw std::invalid_argument(name + "=NUMBER is missing");
        return found->second;
    }

    [[nodiscard]] unsigned count(const std::string& name) const {
        const double value = number(name);
        if (!(value >= 0 && value < 4e9)) {
            throw std::invalid_argument(name + " is a whole number of 0 or more");
        }
        return static_cast<unsigned>(value);
    }

private:
    std::map<std::string, double> values_;
};

}  // namespace lpf::peers

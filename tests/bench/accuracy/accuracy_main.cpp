// lpf-accuracy: the error that is left on scans with a known answer, with no parameter given, for
// one seed or several, as a table in Markdown.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>

#include "tests/bench/accuracy/cases.h"
#include "tests/support/scan_file.h"

namespace lpf::accuracy {
namespace {

struct Command {
    std::vector<std::string> only;
    std::vector<std::uint64_t> seeds = {2024};
    bool all_presentations = false;
    std::string fandisk;
    int threads = 2;
};

std::string text(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.4g", value);
    return buffer;
}

void print_header(const std::vector<std::string>& runs) {
    std::cout << "| case | figure | aim |";
    for (const std::string& run : runs) std::cout << " " << run << " |";
    std::cout << (runs.size() > 1 ? " scatter |" : "") << " met |\n|";
    for (std::size_t k = 0; k < 4 + runs.size() + (runs.size() > 1); ++k) std::cout << " --- |";
    std::cout << std::endl;
}

/// Half of the range over the mean, in per cent.
std::string scatter(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    return text(high > low ? 100 * (high - low) / (high + low) : 0.0) + " %";
}

/// The figures of a case, one row each.
/// @param runs the figures of each
void print_rows(const Case& each, const std::vector<std::vector<Figure>>& runs) {
    for (std::size_t i = 0; i < runs.front().size(); ++i) {
        const Figure& first = runs.front()[i];
        std::cout << "| " << each.name << " | " << first.name << " | " << text(first.aim) << " |";
        std::vector<double> values;
        bool is_met = true;
        for (const std::vector<Figure>& run : runs) {
            values.push_back(run[i].value);
            is_met &= run[i].value <= run[i].aim;
            std::cout << " " << text(values.back()) << " |";
        }
        if (runs.size() > 1) std::cout << " " << scatter(values) << " |";
        std::cout << (is_met ? " yes |\n" : " **no** |\n");
    }
    std::cout << std::flush;
}

struct Run {
    std::string name;
    Conditions conditions;
};

/// One scan presented in many ways, or many scans as they are.
std::vector<Run> runs_of(const Command& command) {
    Conditions usual{.seed = command.seeds.front(), .execution = {.threads = command.threads}};
    if (!command.fandisk.empty()) usual.fandisk = test::read_mesh(command.fandisk);
    std::vector<Run> runs;
    if (command.all_presentations) {
        for (const Presentation& presentation : presentations()) {
            runs.push_back({presentation.name, usual});
            runs.back().conditions.presentation = presentation;
        }
        return runs;
    }
    for (const std::uint64_t seed : command.seeds) {
        runs.push_back({"seed " + std::to_string(runs.size() + 1), usual});
        runs.back().conditions.seed = seed;
    }
    return runs;
}

int run(const Command& command) {
    const std::vector<Run> runs = runs_of(command);
    std::vector<std::string> names;
    for (const Run& each : runs) names.push_back(each.name);
    print_header(names);
    for (const Case& each : cases()) {
        if (!command.only.empty() && !std::ranges::count(command.only, each.name)) continue;
        std::vector<std::vector<Figure>> figures;
        for (const Run& run : runs) figures.push_back(each.measure(run.conditions));
        print_rows(each, figures);
    }
    return 0;
}

std::string description() {
    std::string words =
        "The error left on scans with a known answer, with no parameter given.\n\nCases:\n";
    for (const Case& each : cases()) words += "  " + each.name + ": " + each.what + "\n";
    return words;
}

int parse_and_run(int argc, char** argv) {
    CLI::App app(description(), "lpf-accuracy");
    Command command;
    std::vector<std::string> names;
    for (const Case& each : cases()) names.push_back(each.name);
    app.add_option("--only", command.only, "Run these cases")
        ->delimiter(',')
        ->check(CLI::IsMember(names));
    app.add_option("--seeds", command.seeds, "Of the points and their noise, one run for each")
        ->delimiter(',')
        ->capture_default_str();
    app.add_flag(
        "--presentations", command.all_presentations,
        "The first seed's scans with other random numbers in the method, far away, turned, "
        "in another unit: the figures are to stay the same");
    app.add_option("--fandisk", command.fandisk, "The paper's Fandisk mesh, PLY or Draco")
        ->check(CLI::ExistingFile);
    app.add_option("--threads", command.threads, "How many")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    }
    return run(command);
}

}  // namespace
}  // namespace lpf::accuracy

int main(int argc, char** argv) {
    try {
        return lpf::accuracy::parse_and_run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "lpf-accuracy: " << error.what() << '\n';
        return 1;
    }
}

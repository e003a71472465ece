#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "core/base/error.h"
#include "tests/paper/document.h"
#include "tests/paper/experiments.h"
#include "tests/support/scan_file.h"

// lpf-paper: reruns the experiments of the paper and writes them down.

namespace lpf::paper {
namespace {

namespace fs = std::filesystem;

struct Command {
    std::string output = "experiments.md";
    std::string pictures = {};
    std::string fandisk = {};
    std::vector<std::string> only = {};
    double size = 1.0;
    Origin origin = {};
};

Settings settings_of(const Command& command) {
    Settings settings{.execution = {.threads = command.origin.threads}, .size = command.size};
    if (!command.fandisk.empty()) settings.fandisk = test::read_mesh(command.fandisk);
    if (!command.pictures.empty()) {
        fs::create_directories(command.pictures);
        settings.picture_folder = command.pictures;
        const fs::path folder = fs::absolute(command.output).parent_path();
        settings.picture_link = fs::absolute(command.pictures).lexically_relative(folder).string();
    }
    return settings;
}

void write(const std::string& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    if (!file.flush()) {
        throw Error(ErrorCode::StorageFailure, "Writing " + path + " failed.");
    }
}

bool is_wanted(const Command& command, const std::string& name) {
    return command.only.empty() || std::ranges::count(command.only, name) > 0;
}

int run(const Command& command) {
    const Settings settings = settings_of(command);
    Origin origin = command.origin;
    for (const Experiment& experiment : experiments()) {
        if (!is_wanted(command, experiment.name)) origin.not_run.push_back(experiment.name);
    }
    std::vector<Finished> finished;
    for (const Experiment& experiment : experiments()) {
        if (!is_wanted(command, experiment.name)) continue;

        std::cerr << experiment.name << " ..." << std::flush;
        Finished done;
        done.seconds = seconds_of([&] { done.section = experiment.run(settings); });
        std::cerr << " " << number(done.seconds, 2).text << " s\n";
        finished.push_back(std::move(done));
        write(command.output, document(finished, origin));  // so that a break loses little
    }
    std::cerr << "Written to " << command.output << "\n";
    return 0;
}

int parse_and_run(int argc, char** argv) {
    CLI::App app("Reruns the experiments of the paper and writes them down", "lpf-paper");
    Command command;
    std::vector<std::string> names;
    for (const Experiment& experiment : experiments()) names.push_back(experiment.name);
    app.add_option("-o,--output", command.output, "Markdown file to write")->capture_default_str();
    app.add_option("--pictures", command.pictures, "Folder for the pictures; none: no pictures");
    app.add_option("--fandisk", command.fandisk, "The paper's Fandisk mesh, PLY or Draco")
        ->check(CLI::ExistingFile);
    app.add_option("--only", command.only, "Run these experiments")->check(CLI::IsMember(names));
    app.add_option("--size", command.size, "Share of the paper's numbers of points and runs")
        ->check(CLI::Range(0.001, 1.0))
        ->capture_default_str();
    app.add_option("--threads", command.origin.threads, "How many")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--machine", command.origin.machine, "What it runs on, for the document");
    app.add_option("--commit", command.origin.commit, "What is measured, for the document");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    }
    return run(command);
}

}  // namespace
}  // namespace lpf::paper

int main(int argc, char** argv) {
    try {
        return lpf::paper::parse_and_run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "lpf-paper: " << error.what() << '\n';
        return 1;
    }
}

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tests/support/scan_commands.h"

// lpf-scan: makes noisy scans with a known answer, measures results against it, draws them.

namespace lpf::test {
namespace {

void add_reference(CLI::App& command, Reference& reference) {
    auto* shape = command.add_option("--shape", reference.shape, "Measure to this simulated shape")
                      ->check(CLI::IsMember(shape_names()));
    command.add_option("--reference", reference.file, "Measure to this file: a mesh or a cloud")
        ->check(CLI::ExistingFile)
        ->excludes(shape);
}

void add_simulate(CLI::App& app, SimulateCommand& command) {
    CLI::App* sub = app.add_subcommand("simulate", "Write a noisy scan of a known shape");
    auto* shape = sub->add_option("--shape", command.shape, "Which shape")
                      ->check(CLI::IsMember(shape_names()))
                      ->capture_default_str();
    sub->add_option("--mesh", command.mesh, "Sample the triangles of this file instead")
        ->check(CLI::ExistingFile)
        ->excludes(shape);
    sub->add_option("--points", command.sampling.points, "How many points")
        ->check(CLI::Range(std::size_t{1}, std::size_t{20'000'000}))
        ->capture_default_str();
    auto* noise = sub->add_option("--noise", command.sampling.noise,
                                  "Standard deviation of the noise, in the shape's units")
                      ->check(CLI::NonNegativeNumber)
                      ->capture_default_str();
    sub->add_option("--noise-percent", command.noise_percent,
                    "The same in per cent of the shape's diagonal")
        ->check(CLI::NonNegativeNumber)
        ->excludes(noise);
    sub->add_option("--seed", command.sampling.seed, "Of the random numbers")
        ->capture_default_str();
    sub->add_option("-o,--output", command.output, "PLY file to write")->required();
    sub->add_option("--clean", command.clean_output, "Also write the points without noise");
    sub->callback([&command] { std::cout << simulate(command).dump(2) << '\n'; });
}

void add_error(CLI::App& app, ErrorCommand& command) {
    CLI::App* sub = app.add_subcommand("error", "Measure a result against the truth");
    sub->add_option("result", command.result, "PLY or Draco file")
        ->required()
        ->check(CLI::ExistingFile);
    add_reference(*sub, command.reference);
    sub->add_flag("--detailed", command.detailed, "Also by part, coverage, spacing");
    sub->add_option("--edge-distance", command.edge_distance,
                    "With details: points so near to a sharp edge are told apart")
        ->check(CLI::NonNegativeNumber);
    sub->callback([&command] {
        if (command.reference.empty()) throw CLI::RequiredError("--shape or --reference");
        std::cout << measure_error(command).dump(2) << '\n';
    });
}

void add_render(CLI::App& app, RenderCommand& command, std::string& size) {
    CLI::App* sub = app.add_subcommand("render", "Draw files side by side as a PNG");
    sub->add_option("inputs", command.inputs, "PLY or Draco files")
        ->required()
        ->check(CLI::ExistingFile);
    sub->add_option("-o,--output", command.output, "PNG file to write")->required();
    sub->add_option("--size", size, "WIDTHxHEIGHT of the whole picture")->capture_default_str();
    sub->add_option("--view", command.direction, "azimuth,elevation in degrees")
        ->delimiter(',')
        ->expected(2);
    sub->add_option("--zoom", command.zoom, "x,y,z,extent: what to look at, how much of it")
        ->delimiter(',')
        ->expected(4);
    sub->add_option("--color", command.colour, "height, plain, distance, rgb or an attribute")
        ->capture_default_str();
    sub->add_option("--limit", command.colour_limit, "Distance at the end of the colour scale");
    sub->add_option("--labels", command.labels, "One per file")->delimiter(',');
    add_reference(*sub, command.reference);
    sub->callback([&command, &size] {
        char x = 0;
        std::istringstream text(size);
        text >> command.size.width >> x >> command.size.height;
        if (!text || x != 'x' || command.size.width < 64 || command.size.height < 64) {
            throw CLI::ValidationError("--size", "is WIDTHxHEIGHT, each at least 64");
        }
        std::cout << render_files(command).dump(2) << '\n';
    });
}

int run(int argc, char** argv) {
    CLI::App app("Simulates noisy scans, measures results and draws them", "lpf-scan");
    app.require_subcommand(1);
    SimulateCommand simulate_command;
    ErrorCommand error_command;
    RenderCommand render_command;
    std::string size = "1200x600";
    add_simulate(app, simulate_command);
    add_error(app, error_command);
    add_render(app, render_command, size);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error);
    }
    return 0;
}

}  // namespace
}  // namespace lpf::test

int main(int argc, char** argv) {
    try {
        return lpf::test::run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "lpf-scan: " << error.what() << '\n';
        return 1;
    }
}

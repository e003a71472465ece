// Gives a fuzz target inputs without libFuzzer, so that any compiler can repeat what was found.
//
//   replay-NAME [FILE or FOLDER ...]      its seeds, plain mutations of them, and the files
//   replay-NAME --write-seeds FOLDER      the seeds as files, for libFuzzer to begin with

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>

#include "tests/fuzz/target.h"

namespace lpf::fuzz {
namespace {

namespace fs = std::filesystem;

void try_input(const std::string& input) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

/// Cuts, changed bytes and repeated pieces, the same ones in every run.
std::size_t try_mutations(const std::string& seed, std::mt19937& dice) {
    constexpr std::size_t kMutations = 400;
    const auto below = [&](std::size_t n) { return n > 0 ? dice() % n : 0; };
    for (std::size_t i = 0; i < kMutations; ++i) {
        std::string input = seed;
        const std::size_t at = below(input.size());
        switch (i % 4) {
            case 0: input.resize(at); break;
            case 1: input[at] = static_cast<char>(dice()); break;
            case 2: input[at] = static_cast<char>(input[at] ^ (1 << below(8))); break;
            default: input.insert(at, seed.substr(below(seed.size()), below(40))); break;
        }
        try_input(input);
    }
    return kMutations;
}

std::vector<fs::path> files_in(const fs::path& path) {
    if (!fs::is_directory(path)) return {path};
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string content_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(in), {}};
}

int write_seeds(const fs::path& folder) {
    fs::create_directories(folder);
    std::size_t number = 0;
    for (const std::string& seed : seeds()) {
        std::ofstream out(folder / ("seed-" + std::to_string(number++)), std::ios::binary);
        out << seed;
        if (!out.flush()) throw std::runtime_error("cannot write to " + folder.string());
    }
    return 0;
}

int replay(const std::vector<std::string>& paths) {
    std::mt19937 dice(1);
    std::size_t inputs = 0;
    for (const std::string& seed : seeds()) {
        try_input(seed);
        inputs += 1 + try_mutations(seed, dice);
    }
    for (const std::string& path : paths) {
        for (const fs::path& file : files_in(path)) {
            try_input(content_of(file));
            ++inputs;
        }
    }
    std::cout << inputs << " inputs, no promise broken\n";
    return inputs > 0 ? 0 : 1;
}

}  // namespace
}  // namespace lpf::fuzz

int main(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    try {
        if (arguments.size() == 2 && arguments[0] == "--write-seeds") {
            return lpf::fuzz::write_seeds(arguments[1]);
        }
        return lpf::fuzz::replay(arguments);
    } catch (const std::exception& error) {
        std::cerr << error.what() << "\n";
        return 1;
    }
}

// Does with a file all that the server does with an upload and its job, in one process, and prints
// what each phase cost:
//
//   lpf-job-cost scan.ply
//   lpf-job-cost scan.ply --task resample --threads 1 --format drc --json

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "api/codec/format.h"
#include "api/codec/summary.h"
#include "api/report.h"
#include "core/auto_parameters.h"
#include "core/denoising/tiled_denoise.h"
#include "core/shape/outliers.h"
#include "server/large_pages.h"
#include "server/shapes/streaming.h"
#include "server/store/file_blob_store.h"
#include "server/store/mapped_file.h"
#include "server/work/computation.h"
#include "tests/bench/jobs/cost_meter.h"

namespace lpf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPiece = 1U << 20U;
const DecodeLimits kAnySize{.max_points = 1'000'000'000, .max_faces = 1'000'000'000};

struct Options {
    std::string file;
    std::string task = "denoise";
    int threads = 2;
    std::string format;
    std::string output;
    bool json = false;
};

/// The paper's timing case (Sec. 4.3): a radius for 100 000 LPFs on `lpf-scan simulate --shape
/// curvenet --points 1100000 --noise 0.05`, its M, d, lambda, iterations and probing operator.
const AnalysisParams kPaperTiming{.radius = 0.235, .atoms = 32, .lambda = 0.2, .iterations = 10};

fs::path temporary_folder() {
    std::string name = (fs::temp_directory_path() / "lpf-job-cost-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    return name;
}

/// Hashes and keeps a file as an upload is kept. @returns where it lies now
fs::path receive(const std::string& file, server::BlobStore& blobs) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file + " cannot be read");
    const auto writer = blobs.create();
    std::string piece(kPiece, '\0');
    while (in.read(piece.data(), kPiece), in.gcount() > 0) {
        writer->write(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
    }
    return blobs.local_file(writer->commit());
}

struct Work {
    std::size_t points = 0;
    std::size_t fields = 0;
};

Points computed(const Options& options, const Shape& shape, const Execution& execution, Work& work,
                CostMeter& meter) {
    if (options.task == "none") return shape.cloud.points;
    if (options.task == "paper") {
        meter.begin("prepare");
        work.fields = analyze(shape, kPaperTiming, execution).frames.size();
        return shape.cloud.points;
    }
    meter.begin("duplicates");
    (void)find_duplicates(shape.cloud.points, {.threads = options.threads});
    meter.begin("measure");
    const Measurements measurements = measure(shape.cloud.points, execution);
    const Task task = options.task == "resample" ? Task::Resample : Task::Denoise;
    const ResolvedParameters parameters = resolve_parameters(task, shape, measurements, {});
    meter.begin("prepare");
    server::Computation result = server::compute(task, shape, parameters, execution);
    work.fields = result.analysis.frames.size();
    return *std::move(result.points);
}

std::optional<PlyPoints> streamed(const Options& options, const server::MappedFile& file) {
    if (options.task != "denoise" || !options.format.empty()) return std::nullopt;
    Limits limits;
    limits.points = kAnySize.max_points;
    return server::streamed_points(Task::Denoise, {}, file, limits);
}

/// What the server does with a file that it does not hold.
Work run_streamed(const Options& options, const PlyPoints& points, server::FileBlobStore& blobs,
                  const Execution& execution, CostMeter& meter) {
    meter.begin("measure");
    const Measurements measurements = measure(points, {.threads = options.threads});
    const ResolvedParameters parameters = resolve_parameters(Task::Denoise, {}, measurements, {});
    meter.begin("prepare");
    const TiledDenoising result =
        denoise_tiles(points, parameters.denoise, execution, {.count_duplicates = true});
    meter.begin("write");
    const auto writer = blobs.create();
    write_moved(points, result.moves, measurements.points, "measured",
                [&](std::string_view piece) { writer->write(piece); }, {});
    const std::string digest = writer->commit();
    meter.begin("report");
    (void)displacement_statistics(server::lengths_of(result.moves, measurements.points));
    meter.end();
    if (!options.output.empty()) {
        fs::copy_file(blobs.local_file(digest), options.output,
                      fs::copy_options::overwrite_existing);
    }
    return {.points = points.size(), .fields = result.analysis.frames.size()};
}

Work run(const Options& options, CostMeter& meter) {
    const fs::path folder = temporary_folder();
    const std::shared_ptr<void> cleaner(nullptr, [&](void*) { fs::remove_all(folder); });
    server::FileBlobStore blobs(folder);
    const Execution execution{
        .threads = options.threads,
        .progress = [&](const Progress& progress) { meter.begin(std::string(progress.phase)); }};

    meter.begin("receive");
    const fs::path kept = receive(options.file, blobs);
    const server::MappedFile file(kept);
    meter.begin("inspect");
    (void)summarize(file.bytes(), kAnySize,
                    {.passed = [&](std::size_t bytes) { file.let_go(bytes); }});
    if (const auto points = streamed(options, file)) {
        return run_streamed(options, *points, blobs, execution, meter);
    }
    meter.begin("decode");
    Document document = decode(file.bytes(), kAnySize, {.threads = options.threads});
    file.let_go(file.bytes().size());
    Work work{.points = document.shape.cloud.size()};
    document.shape.cloud.points = computed(options, document.shape, execution, work, meter);
    meter.begin("write");
    std::vector<Warning> lost;
    EncodeOptions how{.format = parse_format_name(options.format).value_or(document.format)};
    if (how.format == FileFormat::Draco) how.quantization_bits = 16;
    const std::string bytes = encode(document, how, lost, {.threads = options.threads});
    meter.begin("store");
    blobs.put(bytes);
    meter.end();
    if (!options.output.empty()) std::ofstream(options.output, std::ios::binary) << bytes;
    return work;
}

void print_json(const Options& options, const CostMeter& meter, const Work& work) {
    nlohmann::json phases;
    for (const Cost& cost : meter.costs()) {
        phases[cost.phase] = {{"cpuSeconds", cost.cpu_seconds}, {"wallSeconds", cost.wall_seconds}};
    }
    const Cost total = meter.total();
    std::cout << nlohmann::json{{"file", options.file},
                                {"task", options.task},
                                {"threads", options.threads},
                                {"points", work.points},
                                {"fields", work.fields},
                                {"cpuSeconds", total.cpu_seconds},
                                {"wallSeconds", total.wall_seconds},
                                {"peakBytes", peak_memory()},
                                {"phases", phases}}
                     .dump()
              << "\n";
}

void print_table(const CostMeter& meter, const Work& work) {
    const Cost total = meter.total();
    std::printf("%-12s %10s %10s %7s\n", "phase", "CPU s", "wall s", "share");
    const auto row = [&](const Cost& cost) {
        std::printf("%-12s %10.3f %10.3f %6.1f%%\n", cost.phase.c_str(), cost.cpu_seconds,
                    cost.wall_seconds, 100 * cost.cpu_seconds / total.cpu_seconds);
    };
    for (const Cost& cost : meter.costs()) row(cost);
    row(total);
    const auto points = static_cast<double>(work.points);
    std::printf("%zu points, %zu LPFs, %.2f CPU us a point, %.0f points/s, peak %.0f MB\n",
                work.points, work.fields, 1e6 * total.cpu_seconds / points,
                points / total.wall_seconds, 1e-6 * peak_memory());
}

}  // namespace
}  // namespace lpf::bench

int main(int argc, char** argv) {
    using namespace lpf::bench;
    CLI::App app("Prints what the phases of a job cost.");
    Options options;
    app.add_option("file", options.file, "PLY or Draco")->required();
    app.add_option("--task", options.task,
                   "denoise, resample, the timing case of the paper, or none: files alone")
        ->check(CLI::IsMember({"denoise", "resample", "paper", "none"}));
    app.add_option("--threads", options.threads)->check(CLI::Range(1, 1024));
    app.add_option("--format", options.format, "of the result: ply, ply-ascii, drc");
    app.add_option("-o", options.output, "keep the result here");
    app.add_flag("--json", options.json);
    CLI11_PARSE(app, argc, argv);
    lpf::server::use_large_pages(argv);  // as the server does
    try {
        CostMeter meter;
        const Work work = run(options, meter);
        if (options.json) {
            print_json(options, meter, work);
        } else {
            print_table(meter, work);
        }
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lpf-job-cost: %s\n", error.what());
        return 1;
    }
}

#!/usr/bin/env python3
"""Runs whole jobs with lpf-job-cost and prints what they cost; compares two builds.

  bench.py cost BIN [--cases net,paper] [--runs 3] [--pcl PROGRAM]   a table in Markdown
  bench.py compare BEFORE AFTER [--cases ...] [--runs 5]             ratios, phase by phase

BIN, BEFORE, AFTER: folders with lpf-job-cost, lpf-decode and lpf-scan (simulated scans are made by
the last one named). Of several runs the one with the fewest CPU seconds counts: others only
measure what else the machine does. Builds are run in turns.
"""

import argparse
import json
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

# name: (shape, points, noise, options of lpf-job-cost, what it is)
CASES = {
    "net": ("curvenet", 400_000, 0.124, [], "denoise, 400 000 points"),
    "net-alone": ("curvenet", 400_000, 0.124, ["--threads", "1"], "the same on one thread"),
    "ascii": ("curvenet", 400_000, 0.124, ["--format", "ply-ascii"], "the same, ASCII PLY"),
    "draco": ("curvenet", 400_000, 0.124, ["--format", "drc"], "the same, Draco"),
    "cube": ("cube", 150_000, 0.05, [], "denoise, 150 000 points"),
    "paper": ("curvenet", 1_100_000, 0.05, ["--task", "paper"],
              "analyse as in Sec. 4.3 of the paper: M 193, d 32, 10 iterations"),
    "resample": ("cube_with_curve", 80_000, 0.01, ["--task", "resample"],
                 "resample 80 000 points to as many"),
    "large": ("curvenet", 15_000_000, 0.02, [], "denoise, 15 million points"),
    "large-alone": ("curvenet", 15_000_000, 0.02, ["--threads", "1"], "the same on one thread"),
    "large-resample": ("curvenet", 15_000_000, 0.02, ["--task", "resample"],
                       "resample 15 million points to as many"),
    "huge": ("curvenet", 100_000_000, 0.01, [], "denoise, 100 million points"),
}
MOST_SIMULATED = 20_000_000
USUAL = ["net", "net-alone", "ascii", "draco", "cube", "paper", "resample"]
FORMATS = {"ascii": "ply-ascii", "draco": "drc"}
AROUND = ["receive", "inspect", "decode", "write", "store"]  # not the method
UPLOAD = ["receive", "inspect"]  # done before there is a job
RADIUS_OF_PCL = 0.3972  # best of the settings tried in docs/peers.md
ORDER_OF_PCL = 2


def simulate(binaries, shape, points, noise, path):
    """A scan; of more points than lpf-scan makes, several scans of the shape, one behind the other."""
    parts = -(-points // MOST_SIMULATED)
    part = path.with_suffix(".part")
    with path.open("wb") as out:
        for seed in range(1, parts + 1):
            subprocess.run([binaries / "lpf-scan", "simulate", "--shape", shape, "--points",
                            str(points // parts), "--noise", str(noise), "--seed", str(seed),
                            "-o", part], check=True, stdout=subprocess.DEVNULL)
            with part.open("rb") as rows:
                head = b""
                while not head.endswith(b"end_header\n"):
                    head += rows.readline()
                if seed == 1:
                    out.write(head.replace(f"vertex {points // parts}".encode(),
                                           f"vertex {points}".encode()))
                shutil.copyfileobj(rows, out, 1 << 24)
    part.unlink()


def scan_of(case, binaries, folder):
    """The simulated scan of a case, made if it is not there."""
    shape, points, noise = CASES[case][:3]
    path = folder / f"{shape}-{points}-{noise}.ply"
    if not path.exists():
        simulate(binaries, shape, points, noise, path)
    if case not in FORMATS:
        return path
    # The program itself turns it into the format that the case reads and writes.
    other = folder / f"{path.stem}.{case}"
    if not other.exists():
        subprocess.run([binaries / "lpf-job-cost", path, "--task", "none", "--format",
                        FORMATS[case], "-o", other],
                       check=True, stdout=subprocess.DEVNULL)
    return other


def run_once(binaries, case, scan):
    command = [binaries / "lpf-job-cost", scan, "--json", *CASES[case][3]]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def least(costs):
    """Of several runs of a case the one that measured the least of anything else."""
    return min(costs, key=lambda cost: cost["cpuSeconds"])


def share_around(cost):
    """Share of the CPU that goes into bytes: receiving, checking, decoding, encoding, storing."""
    spent = sum(cost["phases"].get(phase, {}).get("cpuSeconds", 0) for phase in AROUND)
    return spent / cost["cpuSeconds"]


def job_seconds(cost):
    """Wall seconds of the job alone."""
    return sum(spent["wallSeconds"] for phase, spent in cost["phases"].items()
               if phase not in UPLOAD)


def row_of(case, cost):
    return (f"| {CASES[case][4]} | {cost['fields']:,} | {cost['cpuSeconds']:.2f} | "
            f"{cost['wallSeconds']:.2f} | {1e6 * cost['cpuSeconds'] / cost['points']:.2f} | "
            f"{cost['points'] / cost['wallSeconds']:,.0f} | {cost['peakBytes'] / 1e6:.0f} | "
            f"{100 * share_around(cost):.1f} % |")


HEADER = ("| job | LPFs | CPU s | wall s | CPU µs/point | points/s | peak MB | files |\n"
          "|---|---:|---:|---:|---:|---:|---:|---:|")


def phase_table(costs):
    """The share of each phase, one column a case."""
    phases = []
    for cost in costs.values():
        phases += [phase for phase in cost["phases"] if phase not in phases]
    lines = ["| phase | " + " | ".join(costs) + " |", "|---|" + "---:|" * len(costs)]
    for phase in phases:
        cells = []
        for cost in costs.values():
            spent = cost["phases"].get(phase)
            cells.append(f"{100 * spent['cpuSeconds'] / cost['cpuSeconds']:.1f} %" if spent else "")
        lines.append(f"| {phase} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def pcl_seconds(program, scan, folder):
    """CPU and wall seconds of PCL's moving least squares on the same file."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    subprocess.run([program, "mls", scan, folder / "pcl.ply", f"radius={RADIUS_OF_PCL}",
                    f"order={ORDER_OF_PCL}"], check=True, stdout=subprocess.DEVNULL)
    wall = time.monotonic() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return cpu, wall


def print_costs(options):
    folder = options.scans
    costs = {}
    for case in options.cases:
        scan = scan_of(case, options.binaries, folder)
        runs = [run_once(options.binaries, case, scan) for _ in range(options.runs)]
        costs[case] = least(runs)
    print(HEADER)
    for case, cost in costs.items():
        print(row_of(case, cost))
    print()
    print(phase_table(costs))
    for case in ("net", "large"):
        if case in costs and f"{case}-alone" in costs:
            ratio = job_seconds(costs[f"{case}-alone"]) / job_seconds(costs[case])
            print(f"\nTwo threads run the job '{CASES[case][4]}' {ratio:.2f} times as fast as one, "
                  "from decoding to storing.")
    if options.pcl and "net" in costs:
        cpu, wall = pcl_seconds(options.pcl, scan_of("net", options.binaries, folder), folder)
        ours = costs["net"]["cpuSeconds"]
        print(f"\nPCL's MLS on the scan of the first row: {cpu:.2f} CPU s, {wall:.2f} wall s; ours "
              f"takes 1/{cpu / ours:.1f} of its CPU seconds.")


def ratio_lines(before, after):
    """Before, after and their ratio: CPU, wall and memory in all, CPU phase by phase."""
    lines = []
    for name, key, scale, unit in (("CPU", "cpuSeconds", 1, "s"), ("wall", "wallSeconds", 1, "s"),
                                   ("peak", "peakBytes", 1e-6, "MB")):
        a, b = before[key], after[key]
        lines.append(f"  {name:10} {a * scale:10.3f} {b * scale:10.3f} {unit:3} {b / a:8.2f}")
    for phase in after["phases"]:
        a = before["phases"].get(phase, {}).get("cpuSeconds")
        b = after["phases"][phase]["cpuSeconds"]
        # What takes no time has no ratio.
        told = f"{a:10.3f} {b:10.3f} s   " if a is not None else f"{'':10} {b:10.3f} s   "
        lines.append(f"    {phase:8} {told} {b / a:8.2f}" if a and a > 0.01 else
                     f"    {phase:8} {told}")
    return lines


def print_comparison(options):
    for case in options.cases:
        scan = scan_of(case, options.binaries, options.scans)
        runs = {options.before: [], options.binaries: []}
        for _ in range(options.runs):
            for binaries, costs in runs.items():
                costs.append(run_once(binaries, case, scan))
        print(f"{case}: {CASES[case][4]}" + " " * 8 + "before, after, ratio")
        print("\n".join(ratio_lines(least(runs[options.before]), least(runs[options.binaries]))))


def parsed(arguments):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    cost = commands.add_parser("cost")
    compare = commands.add_parser("compare")
    compare.add_argument("before", type=Path)
    for command in (cost, compare):
        command.add_argument("binaries", type=Path)
        command.add_argument("--scans", type=Path, default=Path("build/bench"))
        command.add_argument("--runs", type=int, default=3)
        command.add_argument("--cases", default=",".join(USUAL))
    cost.add_argument("--pcl", type=Path, help="pcl-peer, as scripts/bench-peers.sh builds it")
    options = parser.parse_args(arguments)
    options.cases = options.cases.split(",")
    unknown = [case for case in options.cases if case not in CASES]
    if unknown:
        parser.error(f"no case '{unknown[0]}': {', '.join(CASES)}")
    return options


def main(arguments):
    options = parsed(arguments)
    options.scans.mkdir(parents=True, exist_ok=True)
    if options.command == "cost":
        print_costs(options)
    else:
        print_comparison(options)


if __name__ == "__main__":
    main(sys.argv[1:])

#!/usr/bin/env python3
"""Denoises and resamples the same scans by the service and by its peers, and compares the results.

Each peer has its best of a few settings, the service none at all. Every run is kept in the output
folder, and is not repeated unless its scan or its settings change; ours is always measured
anew. scripts/bench-peers.sh installs and builds what this needs, and passes its options on.
"""

import argparse
import contextlib
import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import meshlab
import shapes
import table
from methods import METHODS, Programs

ROOT = Path(__file__).resolve().parents[3]
INTRODUCTION = Path(__file__).with_name("introduction.md")


def names(known):
    """A type for argparse: a list of known names, parted by commas."""
    def parse(text):
        chosen = text.split(",")
        unknown = set(chosen) - set(known)
        if unknown:
            raise argparse.ArgumentTypeError(f"{', '.join(sorted(unknown))} is not among "
                                             f"{', '.join(known)}")
        return chosen
    return parse


def options():
    parser = argparse.ArgumentParser(prog="scripts/bench-peers.sh", description=__doc__)
    shape_names = [shape.name for shape in shapes.SHAPES]
    method_names = [method.name for method in METHODS]
    parser.add_argument("--shapes", type=names(shape_names), default=shape_names,
                        help="some of " + ",".join(shape_names))
    parser.add_argument("--methods", type=names(method_names), default=method_names,
                        help="some of " + ",".join(method_names))
    parser.add_argument("--mesh", help="a mesh to scan for the shapes fandisk_*; without it they "
                                       "are left out")
    parser.add_argument("--seed", type=int, default=2601, help="of the noise")
    parser.add_argument("--cpu-limit", type=int, default=900, help="CPU seconds of each run")
    parser.add_argument("--tries", type=int, default=9, help="at most so many settings of each")
    parser.add_argument("--again", action="store_true", help="repeat runs of the peers, too")
    parser.add_argument("--table", action="store_true", help="run nothing: what is kept as a table")
    parser.add_argument("--write", type=Path, help="write the table to this Markdown file")
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin",
                        help="folder of lpf-server and lpf-scan")
    parser.add_argument("--out", type=Path, default=ROOT / "build/peers")
    return parser.parse_args()


def commit():
    told = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    return told.stdout.strip()


def machine():
    model = "an unnamed processor"
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            model = line.partition(":")[2].strip()
            break
    cores = len(os.sched_getaffinity(0))
    return f"{cores} cores of {model}, {platform.system()}"


class Bench:
    def __init__(self, chosen):
        self.options = chosen
        self.tool = str(chosen.bin / "lpf-scan")
        self.programs = Programs(chosen.bin / "lpf-server", chosen.out / "programs",
                                 chosen.cpu_limit)
        for folder in ("scans", "runs", "work"):
            (chosen.out / folder).mkdir(parents=True, exist_ok=True)

    def scan(self, shape):
        """The scan of a shape with what it measures itself, or None without a mesh for it."""
        if shape.source == "mesh" and not self.options.mesh:
            return None, None
        folder = self.options.out / "scans"
        scan = shapes.simulate(self.tool, shape, self.options.mesh, self.options.seed, folder)
        kept = folder / f"{scan.path.stem}-error.json"
        if not kept.exists():
            measured = shapes.measure(self.tool, scan, scan.path)
            kept.write_text(json.dumps(measured), encoding="utf-8")
        error = json.loads(kept.read_text(encoding="utf-8"))
        return scan, {"noise": scan.noise, "points": shape.points, "error": error}

    def kept_at(self, scan, method, settings):
        key = ",".join(f"{name}={value}" for name, value in settings.items()) or "automatic"
        return self.options.out / "runs" / f"{scan.path.stem}--{method.name}--{key}.json"

    def kept_runs(self, scan, method):
        """Also those of settings that are no longer among the method's."""
        paths = (self.options.out / "runs").glob(f"{scan.path.stem}--{method.name}--*.json")
        return [json.loads(path.read_text(encoding="utf-8")) for path in sorted(paths)]

    def run(self, scan, method, settings):
        """Runs a method once, measures its result, and keeps what was found."""
        result = self.options.out / "work" / f"{scan.shape.name}-{method.name}.ply"
        result.unlink(missing_ok=True)
        usage = method.run(self.programs, scan, settings, result, result.with_suffix(".log"))
        found = {"shape": scan.shape.name, "method": method.name, "settings": settings,
                 "outcome": usage.outcome, "cpuSeconds": round(usage.cpu_seconds, 2),
                 "memoryBytes": usage.memory_bytes, "commit": commit(), "machine": machine()}
        if usage.outcome == "ok":
            try:
                found["error"] = shapes.measure(self.tool, scan, result)
            except subprocess.CalledProcessError:
                found["outcome"] = "failed: the result cannot be measured"
        self.kept_at(scan, method, settings).write_text(json.dumps(found, indent=1),
                                                        encoding="utf-8")
        return found

    def run_missing(self, scan, method):
        """Runs the settings of a method that were not run before; ours anyway."""
        anew = self.options.again or method.name.startswith("ours")
        for settings in method.settings(scan)[:self.options.tries]:
            if not anew and self.kept_at(scan, method, settings).exists():
                continue
            found = self.run(scan, method, settings)
            rmse = f"{found['error']['rmse']:.4f}" if "error" in found else found["outcome"]
            print(f"{scan.shape.name:16} {method.name:14} {rmse:8} {found['cpuSeconds']:7.1f} CPU s"
                  f"  {table.settings_text(settings)}", file=sys.stderr, flush=True)

    def wanted(self, shape, method):
        return (not self.options.table and shape.name in self.options.shapes
                and method.name in self.options.methods)

    def everything(self):
        """Runs what is to be run. A list of (shape, facts, [(method, runs)])."""
        found = []
        for shape in shapes.SHAPES:
            scan, facts = self.scan(shape)
            if not scan:
                continue
            methods = [m for m in METHODS if shape.resample or not m.resamples]
            for method in methods:
                if self.wanted(shape, method):
                    self.run_missing(scan, method)
            tried = [(method, self.kept_runs(scan, method)) for method in methods]
            found.append((shape, facts, [(method, runs) for method, runs in tried if runs]))
        return [entry for entry in found if entry[2]]


def markdown(found):
    lines = [INTRODUCTION.read_text(encoding="utf-8").rstrip(), ""]
    tried = []
    for shape, facts, methods in found:
        denoised = [(m.label, runs) for m, runs in methods if not m.resamples]
        resampled = [(m.label, runs) for m, runs in methods if m.resamples]
        lines += table.shape_section(shape, facts, denoised, resampled)
        ran = {m.name for m, _ in methods}
        missing = [m.label for m in METHODS
                   if m.name not in ran and (shape.resample or not m.resamples)]
        lines += [f"Not measured: {', '.join(missing)}.", ""] if missing else []
        tried += [(m.label, run) for m, runs in methods for run in runs if run["settings"]]
    ours = {run["commit"] for _, _, methods in found for method, runs in methods for run in runs
            if method.name.startswith("ours")}
    lines += ["## Machine", "", f"{machine()}. LPF Server at commit "
              f"{', '.join(sorted(ours)) or 'none'}.", "", "## All settings tried", ""]
    return "\n".join(lines + table.tried_section(tried)) + "\n"


def main():
    chosen = options()
    bench = Bench(chosen)
    needs_display = any(name.startswith("meshlab") for name in chosen.methods) and not chosen.table
    with meshlab.Display() if needs_display else contextlib.nullcontext():
        found = bench.everything()
    runs = [run for _, _, methods in found for _, tried in methods for run in tried]
    scans = {shape.name: facts for shape, facts, _ in found}
    (chosen.out / "peers.json").write_text(json.dumps({"scans": scans, "runs": runs}, indent=1),
                                           encoding="utf-8")
    text = markdown(found)
    if chosen.write:
        chosen.write.write_text(text, encoding="utf-8")
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Checks that dependencies point one way. Linking cannot: every header lies in an include folder.

    core/base <- core/shape <- core/field <- core/learn <- core <- api/codec <- api <- server/http <- server

Each file may include its own layer and those before it, and each library has its owner files. Any
other folder belongs to the layer that it lies in; such parts do not include each other in a circle.
Usage: check_includes.py [ROOT]
"""

import re
import sys
from fnmatch import fnmatch
from pathlib import Path

from source_tree import CPP_SUFFIXES, line_of, tracked_files, without_comments

LAYERS = ["core/base", "core/shape", "core/field", "core/learn", "core", "api/codec", "api",
          "server/http", "server"]

# Header -> the only files that may include it. Tests and examples may include anything.
OWNERS = {
    "nanoflann.hpp": ["core/shape/spatial_index.cpp"],
    "draco/*": ["api/codec/draco*"],
    "httplib.h": ["server/http/*"],
    "sqlite3.h": ["server/store/sqlite.*"],
    "nlohmann/*": ["api/*", "server/*"],
    "Eigen/*": ["core/*", "api/*", "server/*"],
    "thread": ["core/base/parallel.cpp", "server/*"],
    "future": ["server/*"],
    "omp.h": [],
    "sys/socket.h": ["server/*"],
    "iostream": ["server/*", "api/codec/decode_main.cpp"],
    "fstream": ["server/*", "api/codec/*"],
    "filesystem": ["server/*", "api/codec/*"],
    "cstdio": ["server/*", "api/*"],
}

# What core never does: print, end the process, look around, keep the time of day.
FORBIDDEN_IN_CORE = re.compile(
    r"\bstd::(?:cout|cerr|clog|jthread|thread|async|system_clock)\b"
    r"|\b(?:printf|puts|fprintf|getenv|abort|exit|system|fopen|time)\s*\("
    r"|\bchrono::system_clock\b|#\s*pragma\s+omp\s+parallel")
ALLOWED_IN = {"core/base/parallel.cpp": {"std::jthread"}}

_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?P<open>[<"])(?P<name>[^>"]+)[>"]', re.MULTILINE)


def folder_of(path):
    return path.rpartition("/")[0]


def layer_of(path):
    """Index of the layer of a project file, or None for tests and examples."""
    folder = folder_of(path)
    while folder and folder not in LAYERS:
        folder = folder_of(folder)
    return LAYERS.index(folder) if folder else None


def is_part_and_whole(here, there):
    """Whether two folders are one unit: one is a part of the layer that the other is."""
    return (layer_of(here + "/") == layer_of(there + "/") is not None
            and (folder_of(here) == there or folder_of(there) == here))


def check_include(path, name, project_files):
    """What is wrong with `path` including `name`, or None."""
    layer = layer_of(path)
    if layer is None:
        return None
    for pattern, owners in OWNERS.items():
        if fnmatch(name, pattern) and not any(fnmatch(path, owner) for owner in owners):
            return f"<{name}> belongs to {', '.join(owners) or 'nobody'}"
    if name not in project_files:
        return None
    target = layer_of(name)
    if target is None:
        return f'"{name}" is no part of the product'
    if target > layer:
        return f'"{name}" is of layer {LAYERS[target]}, which lies above {LAYERS[layer]}'
    return None


def check_tokens(path, text):
    """Faults (line, message) of a file of core."""
    for match in FORBIDDEN_IN_CORE.finditer(text):
        token = match.group().rstrip("( \t")
        if token not in ALLOWED_IN.get(path, set()):
            yield line_of(text, match.start()), f"core must not use {token}"


def find_cycle(graph):
    """One cycle of folders as a list, or None."""
    done, trail = set(), []

    def visit(folder):
        if folder in trail:
            return trail[trail.index(folder):] + [folder]
        if folder in done:
            return None
        trail.append(folder)
        for target in sorted(graph.get(folder, ())):
            cycle = visit(target)
            if cycle:
                return cycle
        done.add(trail.pop())
        return None

    return next((cycle for cycle in map(visit, sorted(graph)) if cycle), None)


def check(root):
    """All faults of the tree under `root`, as lines to print."""
    files = {str(path) for path in tracked_files(root) if path.suffix in CPP_SUFFIXES}
    faults, folders = [], {}
    for path in sorted(files):
        text = without_comments((root / path).read_text(encoding="utf-8"), keep_strings=True)
        for match in _INCLUDE.finditer(text):
            name = match.group("name")
            line = line_of(text, match.start("open"))
            fault = check_include(path, name, files)
            if fault:
                faults.append(f"{path}:{line}: {fault}")
            if path.startswith("client-examples/"):  # to be copied out: they include what is beside
                name = path.rpartition("/")[0] + "/" + name
            if match.group("open") == '"' and name not in files:
                faults.append(f'{path}:{line}: "{name}" is not a file of the project; '
                              "includes are rooted at the repository")
            here, there = folder_of(path), folder_of(name)
            if name in files and here != there and not is_part_and_whole(here, there):
                folders.setdefault(here, set()).add(there)
        if path.startswith("core/"):
            code = without_comments(text)
            faults += [f"{path}:{line}: {fault}" for line, fault in check_tokens(path, code)]
    cycle = find_cycle(folders)
    if cycle:
        faults.append("folders include each other in a circle: " + " -> ".join(cycle))
    return faults, len(files)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    faults, count = check(root)
    for fault in faults:
        print(fault)
    if count == 0:
        faults.append("nothing checked")
        print(f"no C++ files under {root}")
    print(f"{count} files checked, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

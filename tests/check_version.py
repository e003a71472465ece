#!/usr/bin/env python3
"""The version has one place, project(lpf VERSION ...) of CMake; whatever must repeat it agrees.

Usage: check_version.py [ROOT]
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Files that people read or apply as they are, and where the version stands in them.
REPEATED = {"CHANGELOG.md": r"^## (\d+\.\d+\.\d+)",
            "deploy/kubernetes/lpf-server.yaml": r"image: lpf-server:(\S+)"}

# Of our own packages, which are never published, and need none.
WITHOUT = ["client-examples/web/package.json", "tests/web/package.json",
           "tests/deploy/package.json"]


def check(root=ROOT):
    """Faults as text, and the number of files looked at."""
    found = re.search(r"^project\(lpf VERSION (\S+)", (root / "CMakeLists.txt").read_text(),
                      re.MULTILINE)
    if not found:
        return ["CMakeLists.txt: project(lpf VERSION ...) is missing"], 1
    version, faults = found[1], []
    for name, pattern in REPEATED.items():
        said = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
        if not said or said[1] != version:
            faults.append(f"{name}: says {said[1] if said else 'no version'}, and CMakeLists.txt "
                          f"{version}")
    faults += [f"{name}: has a version of its own" for name in WITHOUT
               if '"version"' in (root / name).read_text(encoding="utf-8")]
    return faults, 1 + len(REPEATED) + len(WITHOUT)


if __name__ == "__main__":
    result, count = check(Path(sys.argv[1]) if sys.argv[1:] else ROOT)
    print("\n".join(result) or f"check_version: {count} files, one version")
    sys.exit(1 if result else 0)

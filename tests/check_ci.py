#!/usr/bin/env python3
"""Continuous integration leaves the slow sanitizers out, and says how to run them.

Follows the scripts that .ci/run starts. Runs by itself: python3 tests/check_ci.py
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SANITIZER = re.compile(r"sanitize|\basan\b|\btsan\b", re.IGNORECASE)


def commands_and_comments(text):
    """The lines of a shell script, parted."""
    lines = text.splitlines()
    comments = [line for line in lines if line.lstrip().startswith("#")]
    return [line for line in lines if not line.lstrip().startswith("#")], comments


def scripts_run_by(root, first):
    """`first` and every script of scripts/ that its commands reach, relative to `root`."""
    reached, waiting = [], [first]
    while waiting:
        name = waiting.pop()
        if name in reached or not (root / name).is_file():
            continue
        reached.append(name)
        commands, _ = commands_and_comments((root / name).read_text(encoding="utf-8"))
        waiting += re.findall(r"scripts/[\w.-]+\.sh", "\n".join(commands))
    return reached


def check(root=ROOT):
    """Faults as text, and the number of scripts looked at."""
    scripts = scripts_run_by(root, ".ci/run")
    if not scripts:
        return [".ci/run: there is no such file"], 0
    faults = []
    for name in scripts:
        commands, _ = commands_and_comments((root / name).read_text(encoding="utf-8"))
        faults += [f"{name}: runs a sanitizer, which takes too long here: {line.strip()}"
                   for line in commands if SANITIZER.search(line)]
    _, comments = commands_and_comments((root / ".ci/run").read_text(encoding="utf-8"))
    for name, text in [(".ci/run", "\n".join(comments)),
                       ("CONTRIBUTING.md", (root / "CONTRIBUTING.md").read_text(encoding="utf-8"))]:
        if "scripts/sanitize.sh" not in text:
            faults.append(f"{name}: does not say that scripts/sanitize.sh runs the sanitizers")
    return faults, len(scripts)


if __name__ == "__main__":
    found, count = check()
    print("\n".join(found) or f"check_ci: {count} scripts, no sanitizer among them")
    sys.exit(1 if found else 0)

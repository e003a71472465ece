"""What the checks of the source tree share: which files there are, and C++ without its comments."""

import re
import subprocess
from pathlib import Path

CPP_SUFFIXES = {".h", ".cpp"}

_TOKENS = re.compile(
    r"""
    (?P<raw>R"(?P<tag>[^()\\\s]{0,16})\(.*?\)(?P=tag)")
  | (?P<string>"(?:\\.|[^"\\\n])*")
  | (?P<char>(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+')
  | (?P<line>//(?:\\\n|[^\n])*)
  | (?P<block>/\*.*?\*/)
    """,
    re.VERBOSE | re.DOTALL,
)


def tracked_files(root):
    """Paths of all files of the project under `root`, relative to it."""
    try:
        listing = subprocess.run(
            ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
            cwd=root, check=True, capture_output=True, text=True).stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):
        listing = [str(path.relative_to(root)) for path in root.rglob("*")
                   if not {"build", ".git", "node_modules"} & set(path.relative_to(root).parts)]
    return [Path(name) for name in sorted(listing) if (root / name).is_file()]


def without_comments(text, keep_strings=False):
    """C++ with comments blanked out, and the insides of strings unless kept. Lines stay in place."""

    def blank(match):
        token = match.group()
        if match.group("line") or match.group("block"):
            return re.sub(r"[^\n]", " ", token)
        if keep_strings:
            return token
        return token[0] + re.sub(r"[^\n]", " ", token[1:-1]) + token[-1]

    return _TOKENS.sub(blank, text)


def line_of(text, position):
    return text.count("\n", 0, position) + 1

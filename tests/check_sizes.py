#!/usr/bin/env python3
"""Checks that files and functions stay small, and that no path of somebody's machine is in them.

At most 400 lines a source file; at most 60 lines a function, from its signature to its last brace.
Usage: check_sizes.py [ROOT]
"""

import ast
import re
import sys
from pathlib import Path

from source_tree import CPP_SUFFIXES, line_of, tracked_files, without_comments

FILE_LIMIT = 400
FUNCTION_LIMIT = 60
SOURCE_SUFFIXES = CPP_SUFFIXES | {".py", ".sh", ".js", ".mjs", ".ts", ".css", ".html", ".cmake"}
VENDORED = re.compile(r"(^|/)(vendor|third_party)/")
MACHINE_PATH = re.compile(r"(?<![\w.$}\-])/(?:work|farm|root|home/\w+|Users/\w+)/\w")

_DIRECTIVE = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.MULTILINE)
_SCOPE_HEAD = re.compile(
    r'^(?:inline\s+)?namespace\b|^extern\s*" *"\s*$|^(?:template\s*<.*>\s*)?'
    r"(?:typedef\s+)?(?:class|struct|union|enum)\b(?!.*\)\s*(?:const)?\s*$)", re.DOTALL)
_AFTER_PARAMETERS = re.compile(
    r"\)\s*(?:(?:const|noexcept|override|final|mutable|try|&&?)\s*)*(?:->[^;]*)?$")
_IN_MEMBER_LIST = re.compile(r"\)\s*(?:noexcept\s*)?:(?!:)")
_LABEL = re.compile(r"^\s*(?:public|private|protected)\s*:(?!:)")


def _kind_of_brace(head):
    """What an opening brace outside of functions begins, by the text before it."""
    if _SCOPE_HEAD.match(head):
        return "scope"
    if _AFTER_PARAMETERS.search(head):
        return "function"
    if head.endswith("}") and _IN_MEMBER_LIST.search(head):  # the last member was set by braces
        return "function"
    return "values"


def cpp_functions(text):
    """(name, first line, last line) of every function body outside of others, lambdas included."""
    code = _DIRECTIVE.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), without_comments(text))
    stack, start, parens = [], 0, 0
    for match in re.finditer(r"[{};()]", code):
        token, at = match.group(), match.start()
        inside_function = "function" in (kind for kind, _ in stack)
        if inside_function and token not in "{}":
            continue
        if token in "()":
            parens += 1 if token == "(" else -1
        elif token == ";" and parens == 0:
            start = at + 1
        elif token == "{":
            while (label := _LABEL.match(code[start:at])) and not inside_function:
                start += label.end()
            head = code[start:at].strip()
            kind = "block" if inside_function else (
                "values" if parens else _kind_of_brace(head))
            stack.append((kind, start))
            if kind == "scope":
                start = at + 1
        elif token == "}" and stack:
            kind, begin = stack.pop()
            if kind == "function":
                first = begin + len(code[begin:]) - len(code[begin:].lstrip())
                name = " ".join(code[first:].split("(")[0].split())
                yield name, line_of(code, first), line_of(code, at)
            if kind in ("function", "scope"):
                start = at + 1


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node.name, node.lineno, node.end_lineno


def functions_of(path, text):
    if path.suffix in CPP_SUFFIXES:
        return cpp_functions(text)
    return python_functions(text) if path.suffix == ".py" else ()


def check_file(path, text):
    """Faults of one file, as lines to print."""
    for match in MACHINE_PATH.finditer(text):
        yield f"{path}:{line_of(text, match.start())}: a path of one machine: {match.group()}..."
    if path.suffix not in SOURCE_SUFFIXES:
        return
    lines = text.count("\n") + (not text.endswith("\n"))
    if lines > FILE_LIMIT:
        yield f"{path}: {lines} lines; at most {FILE_LIMIT}"
    for name, first, last in functions_of(path, text):
        if last - first + 1 > FUNCTION_LIMIT:
            yield (f"{path}:{first}: {name} has {last - first + 1} lines; "
                   f"at most {FUNCTION_LIMIT}")


def check(root):
    faults, files, functions = [], 0, 0
    for path in tracked_files(root):
        if VENDORED.search(str(path)):
            continue
        try:
            text = (root / path).read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue  # pictures and the like
        files += 1
        functions += sum(1 for _ in functions_of(path, text))
        faults += check_file(path, text)
    return faults, files, functions


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    faults, files, functions = check(root)
    for fault in faults:
        print(fault)
    if files == 0:
        faults.append("nothing checked")
    print(f"{files} files and {functions} functions checked, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Refuses C++ files and functions that are too long to be read at once.

Prints one line per offender and exits with 1 if there is any. Functions are found by
their braces, which clang-format puts on lines of their own; a function counts from the
first line of its signature to its closing brace.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOST_LINES = 450
MOST_FUNCTION_LINES = 60

# What ends before a signature begins: a statement, a block, a comment, an access
# specifier, a preprocessor line, or nothing but white space.
BEFORE_SIGNATURE = re.compile(r"^\s*$|[;}{]\s*$|^\s*(//|/\*|\*|#)|\*/\s*$|^\s*(public|protected|private):")
CONTAINER = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")


def functions(lines):
    """Signature and number of lines of every function whose braces stand on their own lines."""
    i = 0
    while i < len(lines):
        if lines[i].strip() == "{":
            first = i
            while first > 0 and not BEFORE_SIGNATURE.search(lines[first - 1]):
                first -= 1
            signature = " ".join(line.strip() for line in lines[first:i])
            # Templates name their parameters "class", functions have parentheses.
            if "(" in signature or not CONTAINER.search(signature):
                indent = lines[i][: lines[i].index("{")]
                while i + 1 < len(lines) and not lines[i].startswith(indent + "}"):
                    i += 1
                yield signature, i - first + 1
        i += 1


def main():
    offenders = 0
    files = sorted(path for folder in ("Filters", "Plugin")
                   for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cxx"))
    for path in files:
        name = path.relative_to(ROOT)
        lines = path.read_text(encoding="utf-8").splitlines()
        if len(lines) > MOST_LINES:
            offenders += 1
            print(f"{name}: {len(lines)} lines, at most {MOST_LINES}")
        for signature, count in functions(lines):
            if count > MOST_FUNCTION_LINES:
                offenders += 1
                print(f"{name}: {count} lines, at most {MOST_FUNCTION_LINES}: {signature}")
    print(f"{len(files)} files, {offenders} files and functions too long")
    return 1 if offenders else 0


if __name__ == "__main__":
    sys.exit(main())

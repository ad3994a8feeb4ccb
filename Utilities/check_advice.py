#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Refuses advice in the messages of the filters that no test follows.

A text of the sources advises if a clause of it begins with one of the VERBS. A test that does
what such a text says cites its words as Advice("...") in a folder of Testing: Cxx,
Distributed or Mpi. Prints one line for each text without a test and exits with 1 if there is any.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Where a clause begins.
VERBS = re.compile(
    r"(?:^|[:.,;] |\b(?:or|and|then|for \w+ \w+) )"
    r"(?:add|allow|call|choose|close|compute|connect|cut|decimate|extract|fill|fix|flip|gather|give"
    r"|hold|leave|lower|make|mark|merge|move|name|orient|pin|raise|remove|repair|select|set|stay"
    r"|switch|triangulate|try|turn|use)\b", re.IGNORECASE)

# Parts of texts that no test can follow, with the reason, or that do not advise.
EXEMPT = {
    "are supported: decimate or split": "more points or triangles than memory has",
    "Out of memory: decimate the surface": "a test cannot run out of memory",
    "on one rank (Aggregate Dataset": "two ranks, see Testing/Plugin/MpiDistributed.py",
    "tell each other more than MPI can count": "2^31 numbers",
    "does not suffice: use more ranks": "a test cannot run out of memory",
    "cut because the two triangles cannot agree": "a report of what was done",
}

COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
LITERALS = re.compile(r'(?:"(?:[^"\\\n]|\\.)*"\s*)+')
PART = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
FOLLOWED = re.compile(r'\bAdvice\(\s*(' + LITERALS.pattern + r')\)')


def joined(literals):
    """The text of adjacent string literals."""
    return "".join(PART.findall(literals)).strip()


def texts(source):
    """The texts of a C++ source, of at least three words; a literal after another continues it."""
    source = re.sub(r"^\s*#.*$", "", COMMENT.sub("", source), flags=re.MULTILINE)
    found = (joined(literals) for literals in LITERALS.findall(source))
    return [text for text in found if len(text.split()) > 2]


def is_followed(text, phrases):
    return any(phrase in text or text in phrase for phrase in phrases)


def sources():
    return [path for path in sorted((ROOT / "Filters").rglob("*")) if path.suffix in (".h", ".cxx")]


def main():
    phrases = {joined(literals) for folder in ("Cxx", "Distributed", "Mpi")
               for path in (ROOT / "Testing" / folder).glob("*.cxx")
               for literals in FOLLOWED.findall(path.read_text(encoding="utf-8"))}
    phrases.update(EXEMPT)
    count = untested = 0
    for path in sources():
        for text in texts(path.read_text(encoding="utf-8")):
            if VERBS.search(text):
                count += 1
                if not is_followed(text, phrases):
                    untested += 1
                    print(f"{path.relative_to(ROOT)}: no test follows this advice: {text}")
    print(f"{count} texts that advise, {untested} without a test")
    return 1 if untested else 0


if __name__ == "__main__":
    sys.exit(main())

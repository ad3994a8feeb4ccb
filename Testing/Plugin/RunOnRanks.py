"""Runs a command and counts in what all its ranks print.

    RunOnRanks.py COMMAND...

A line "expected N times: TEXT" of the output says in how many other lines TEXT must be. Fails
if one is wrong, if there is none, or if the command fails.
"""
import re
import subprocess
import sys

EXPECTED = re.compile(r"^expected (\d+) times: (.*)$")


def main():
    process = subprocess.Popen(sys.argv[1:], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, errors="replace")
    lines = []
    for line in process.stdout:  # at once: the test's driver watches for exceptions
        print(line, end="", flush=True)
        lines.append(line.rstrip("\n"))
    expected = [match for match in map(EXPECTED.match, lines) if match]
    failed = process.wait() != 0 or not expected
    for match in expected:
        count = sum(match[2] in line and not EXPECTED.match(line) for line in lines)
        if count != int(match[1]):
            print("found %d times, not %s: %s" % (count, match[1], match[2]))
            failed = True
    return 1 if failed else 0


sys.exit(main())

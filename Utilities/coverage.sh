#!/usr/bin/env bash
# Runs the kernel and filter tests of a build for coverage, in build-coverage/, and
# prints the line coverage of the filters and of the kernel. With --html, it also
# writes build-coverage/html/index.html, which shows the lines.
set -euo pipefail
if [ $# -gt 1 ] || [ "${1---html}" != --html ]; then
  echo "usage: $0 [--html]" >&2
  exit 2
fi
cd "$(dirname "$0")/.."

Utilities/bootstrap.sh
cmake --preset coverage
cmake --build --preset coverage --parallel "$(nproc)"
# Counts add up over runs; only this one is asked for.
find build-coverage -name '*.gcda' -delete
# A test that fails, or is too slow with counters, has covered its lines all the same.
failed=0
ctest --preset coverage --parallel "$(nproc)" || failed=$?

gcovr --root . --json build-coverage/coverage.json --filter Filters/ build-coverage
report() { gcovr --root . --add-tracefile build-coverage/coverage.json "$@"; }
if [ "${1-}" = --html ]; then
  mkdir -p build-coverage/html
  report --html-details build-coverage/html/index.html
fi
report
echo "Filters without the kernel:"
report --exclude Filters/Kernel/ --print-summary --output /dev/null | grep lines
echo "Filters/Kernel:"
report --filter Filters/Kernel/ --print-summary --output /dev/null | grep lines
exit "$failed"

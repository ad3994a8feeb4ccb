#!/usr/bin/env bash
# Generated surfaces through every filter, on all processors: fuzz.sh [seconds [option...]].
# An hour by default, with seeds that no run had before; options go to CartanFuzz (see
# CartanFuzz --help). Scripts that reproduce failures go to build/Fuzz. The exit status
# is 1 if anything failed.
set -uo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-3600}
shift || true
program=build/bin/CartanFuzz
if [ ! -x "$program" ]; then
  echo "There is no $program: run Utilities/test.sh first." >&2
  exit 2
fi

folder=build/Fuzz/$(date +%Y%m%d-%H%M%S)
mkdir -p "$folder"
first=$(($(date +%s) * 1000000))
pids=()
for ((i = 0; i < $(nproc); ++i)); do
  "$program" --seeds $((first + i * 100000000000)): --seconds "$seconds" \
    --folder "$folder" "$@" > "$folder/log-$i.txt" &
  pids+=($!)
done
status=0
for pid in "${pids[@]}"; do
  wait "$pid" || status=1
done
grep -h "^FAILED" -A 1 "$folder"/log-*.txt
sed -s '1,/^filter /d' "$folder"/log-*.txt
exit $status

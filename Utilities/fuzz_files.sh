#!/usr/bin/env bash
# libFuzzer on the decoder of compressed surfaces, with AddressSanitizer and
# UndefinedBehaviorSanitizer:
#
#     Utilities/fuzz_files.sh [seconds]
#
# runs for a minute, or as long as it is told, from seeds that a program generates. Prints the
# number of executions and the coverage (edges of the control flow) at its end. An input that
# fails is left in build-fuzz/.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake -S Testing/FuzzFiles -B build-fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++-14
cmake --build build-fuzz
mkdir -p build-fuzz/seeds build-fuzz/corpus
build-fuzz/MakeSeeds build-fuzz/seeds
cd build-fuzz
./FuzzFiles -max_total_time="${1:-60}" -max_len=4096 -timeout=20 -malloc_limit_mb=64 \
  -rss_limit_mb=1024 -print_final_stats=1 corpus seeds

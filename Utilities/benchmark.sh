#!/usr/bin/env bash
# Configures, builds and runs the benchmarks in build/benchmarks: similarity
# editing, as-rigid-as-possible deformation, the methods of differential coordinates,
# drags of large surfaces and their set-up, drags by example poses, sewing, morphs, spectra,
# compressed files and surfaces in pieces, each with a table of what was asked and what was
# measured, then the motions of rotation-invariant and shape-preserving editing by Google
# Benchmark, with such a table at the end. Arguments are Google Benchmark's, for example
# --benchmark_filter=104K. Takes tens of minutes and means something only on a machine
# that does nothing else.
#
#     Utilities/benchmark.sh --against COMMIT
#
# times every method of this checkout against those of another commit instead, by
# Utilities/compare_times.py. Takes about an hour.
set -euo pipefail
cd "$(dirname "$0")/.."

Utilities/bootstrap.sh
if [ "${1-}" = --against ]; then
  rm -rf build/against
  mkdir -p build/against
  git archive "$2" | tar -x -C build/against
  for folder in build/against .; do
    cmake -S "$folder" -B "$folder/build/times" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DCARTAN_BUILD_PLUGIN=OFF -DCARTAN_WRAP_PYTHON=ON
    for target in $(ninja -C "$folder/build/times" -t targets all |
      sed -nE 's/^((vtk)?CartanPython): phony$/\1/p'); do
      cmake --build "$folder/build/times" --target "$target" --parallel "$(nproc)"
    done
  done
  exec Utilities/compare_times.py build/against/build/times build/times
fi
cmake -S . -B build/benchmarks -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCARTAN_BUILD_BENCHMARKS=ON -DCARTAN_BUILD_TESTING=OFF \
  -DCARTAN_BUILD_PLUGIN=OFF -DCARTAN_WRAP_PYTHON=OFF
cmake --build build/benchmarks --target benchmarks
build/benchmarks/bin/CartanBenchmarkSimilarity
build/benchmarks/bin/CartanBenchmarkAsRigidAsPossible
build/benchmarks/bin/CartanBenchmarkDifferential
timeout 1800 build/benchmarks/bin/CartanBenchmarkDrag 1 2 3 ||
  echo "CartanBenchmarkDrag has not ended within half an hour: its last rows are missing."
build/benchmarks/bin/CartanBenchmarkSetUp
OMP_NUM_THREADS=1 build/benchmarks/bin/CartanBenchmarkExamples
OMP_NUM_THREADS=1 build/benchmarks/bin/CartanBenchmarkMerge
build/benchmarks/bin/CartanBenchmarkMorph
OMP_NUM_THREADS=1 build/benchmarks/bin/CartanBenchmarkSpectrum
OMP_NUM_THREADS=1 build/benchmarks/bin/CartanBenchmarkCompression
for solver in cholmod cg; do
  OMP_NUM_THREADS=1 build/benchmarks/bin/CartanBenchmarkSolver 400000 "$solver"
done
if [ -x build/benchmarks/bin/CartanBenchmarkDistributed ]; then
  mpiexec --allow-run-as-root -n 2 build/benchmarks/bin/CartanBenchmarkDistributed \
    armadillo1 armadillo2 armadillo3 1664000
fi
build/benchmarks/bin/CartanBenchmarkDeformation "$@"

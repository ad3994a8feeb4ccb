#!/usr/bin/env bash
# Installs what is missing, configures, builds, bends four scanned surfaces, and makes
# the gallery and the morphs. Pictures, animations, surfaces and a ParaView state appear
# in build/demo; what was measured is printed. With --compare, it puts all methods side
# by side instead; with --spectrum, it draws figures of the Laplacian framework.
set -euo pipefail
if [ $# -gt 1 ] || { [ "${1---compare}" != --compare ] && [ "$1" != --spectrum ]; }; then
  echo "usage: $0 [--compare | --spectrum]" >&2
  exit 2
fi
cd "$(dirname "$0")/.."

Utilities/bootstrap.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target CartanPlugin vtkCartanPython
Utilities/demo/run.sh build "$@"

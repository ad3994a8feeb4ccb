#!/usr/bin/env bash
# Installs what is missing, configures, builds, bends four scanned surfaces, and makes
# the gallery and the morphs. Pictures, animations, surfaces and a ParaView state appear
# in build/demo; what was measured is printed. With --compare, it puts all methods side
# by side instead; with --spectrum, it draws figures of the Laplacian framework, and with
# --merge surfaces that are sewn together and coated; with --examples, bodies, example poses,
# curves and landmarks; with --landmarks, it times landmarks.
set -euo pipefail
case "$#${1-}" in
  0 | 1--compare | 1--spectrum | 1--merge | 1--examples | 1--landmarks) ;;
  *)
    echo "usage: $0 [--compare | --spectrum | --merge | --examples | --landmarks]" >&2
    exit 2
    ;;
esac
cd "$(dirname "$0")/.."

Utilities/bootstrap.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target CartanPlugin vtkCartanPython
Utilities/demo/run.sh build "$@"

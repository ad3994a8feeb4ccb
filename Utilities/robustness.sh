#!/usr/bin/env bash
# Every filter on every mesh of libcgal-demo, before and after Prepare Surface: the
# tables of Documentation/Robustness.md. robustness.sh [BUILD] [option...]; options are
# those of robustness.py. Needs the Python module (Utilities/test.sh builds it).
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
build=$here/build
if [ $# -gt 0 ] && [ -d "$1" ]; then
  build=$(realpath "$1")
  shift
fi

CARTAN_MESH_DIR=$(sed -n 's/^CARTAN_MESH_DIR:[A-Z]*=//p' "$build/CMakeCache.txt")
export CARTAN_MESH_DIR=${CARTAN_MESH_DIR:-$build/MeshData}
python_module=$(echo "$build"/lib/python3*/*-packages)
export PYTHONPATH=$python_module:$here/Testing/Python
exec pvpython "$here/Utilities/robustness.py" "$@"

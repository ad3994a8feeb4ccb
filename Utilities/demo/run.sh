#!/usr/bin/env bash
# Runs the demo, or what a word asks for instead, with the plugin and the Python module of a
# build folder: run.sh BUILD [--compare | --spectrum | --merge | --examples | --landmarks].
# Utilities/demo.sh and the target `demo` call it.
set -euo pipefail
build=$(realpath "$1")
cd "$(dirname "$0")/../.."

CARTAN_MESH_DIR=$(sed -n 's/^CARTAN_MESH_DIR:[A-Z]*=//p' "$build/CMakeCache.txt")
export CARTAN_MESH_DIR=${CARTAN_MESH_DIR:-$build/MeshData}
export PYTHONPATH=$PWD/Testing/Python

# A screen of its own, whose number the server chooses: xvfb-run guesses one, and
# another process may be faster. It must not reset when a first window closes.
mkdir -p "$build/demo"
number=$build/demo/.screen
: > "$number"
Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp -noreset 3> "$number" 2> /dev/null &
screen=$!
trap 'kill "$screen"; rm -f "$number"' EXIT
until [ -s "$number" ]; do
  kill -0 "$screen"
  sleep 0.1
done
DISPLAY=:$(cat "$number")
export DISPLAY

python_module=$build/lib/python3.11/site-packages
if [ $# -gt 1 ]; then
  # compare.py and so on.
  PYTHONPATH=$python_module:$PYTHONPATH pvpython "Utilities/demo/${2#--}.py" "$build"
  exit
fi
pvpython Utilities/demo/demo.py "$build"
# In a process of its own: what a user does who opens the state.
pvpython Utilities/demo/open_state.py "$build"
# Volumes against the published ones, and figures like the published ones.
export PYTHONPATH=$python_module:$PYTHONPATH
pvpython Utilities/demo/tableone.py
pvpython Utilities/demo/gallery.py "$build"
# Video encoders find fault with their own picture format, once for each picture.
pvpython Utilities/demo/morph.py "$build" 2> >(grep -v swscaler >&2)

#!/bin/sh
# Makes the pictures of Documentation/Tutorial.md and ParaView.md: plays them in ParaView's window, as
# the tests gui.Tutorial and gui.ParaViewPage do, and takes what was on the screen.
#
#   Utilities/tutorial.sh [BUILD]
set -e
source=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "${1:-$source/build}" && pwd)
cd "$build"
ctest -R '^gui\.(Tutorial|ParaViewPage)$' --output-on-failure
cp -v "$build"/Testing/Output/tutorial-*.png "$build"/Testing/Output/gui-*.png \
  "$source/Documentation/Images"

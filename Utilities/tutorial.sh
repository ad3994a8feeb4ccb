#!/bin/sh
# Makes the pictures of Documentation/Tutorial.md: plays the tutorial in ParaView's window, as the
# test gui.Tutorial does, and takes what was on the screen.
#
#   Utilities/tutorial.sh [BUILD]
set -e
source=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "${1:-$source/build}" && pwd)
cd "$build"
ctest -R '^gui.Tutorial$' --output-on-failure
cp -v "$build"/Testing/Output/tutorial-*.png "$source/Documentation/Images"

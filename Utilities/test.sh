#!/usr/bin/env bash
# Installs what is missing, configures, builds, and runs all tests in build/.
# The exit status is that of the tests.
set -euo pipefail
cd "$(dirname "$0")/.."

Utilities/bootstrap.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)"
ctest --preset release --no-tests=error --parallel "$(nproc)"

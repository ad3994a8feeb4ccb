#!/usr/bin/env bash
# Everything that must hold before a change is accepted, or the stages that are named:
#
#   format   clang-format on every C++ file
#   layers   what may include what, how long it may be, and that advice has tests
#   doxygen  the class reference, without warnings
#   tests    Utilities/test.sh: all tests of a release build, warnings are errors
#   tidy     clang-tidy on the kernel
#   asan     kernel and filter tests with AddressSanitizer and UndefinedBehaviorSanitizer,
#            without plugin, Python and CHOLMOD; and libFuzzer for a minute on the
#            decoder of compressed surfaces
#   tsan     filter tests with ThreadSanitizer and VTK's STDThread backend
#
# A stage that fails, or cannot run, does not stop the others. The time of each is
# printed. The last line counts all tests, and as one each stage that has no tests.
set -uo pipefail
cd "$(dirname "$0")/.."

need()
{
  for tool in "$@"; do
    if ! command -v "$tool" > /dev/null; then
      echo "This stage cannot run: there is no $tool. Utilities/bootstrap.sh installs it."
      return 1
    fi
  done
}

cxx_files() { git ls-files -z --cached --others --exclude-standard -- '*.h' '*.cxx'; }

packages() { Utilities/bootstrap.sh; }

format()
{
  need clang-format-14 git
  cxx_files | xargs -0 clang-format-14 --dry-run -Werror
}

layers()
{
  Utilities/check_layers.py
  Utilities/check_sizes.py
  Utilities/check_advice.py
}

doxygen()
{
  need doxygen
  mkdir -p build
  command doxygen Documentation/Doxyfile
}

tests() { Utilities/test.sh; }

tidy()
{
  need clang-tidy-14 git
  # The commands of the compiler; nothing is built. Eigen is read once for several files,
  # which a unit includes: that is all that one check has to say about units.
  cmake --preset release -B build-tidy -DCARTAN_COMPILE_TOGETHER=ON -DCARTAN_BUILD_TESTING=OFF \
    -DCARTAN_BUILD_PLUGIN=OFF -DCARTAN_WRAP_PYTHON=OFF > /dev/null
  # The number of warnings that it then does not show is that of Eigen's.
  sed -nE 's|^ *"file": "(.*/Kernel/.*)",?$|\1|p' build-tidy/compile_commands.json |
    xargs -n 1 -P "$(nproc)" clang-tidy-14 --quiet --checks=-bugprone-suspicious-include \
      -p build-tidy 2>&1 |
    sed '/^[0-9]* warnings\? generated\.$/d'
}

asan()
{
  sanitizer asan
  Utilities/fuzz_files.sh 60
}

tsan() { sanitizer tsan; }

sanitizer()
{
  cmake --preset "$1"
  cmake --build --preset "$1" --parallel "$(nproc)"
  ctest --preset "$1" --no-tests=error --parallel "$(nproc)"
}

passed=0
failed=0
times=()
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# Runs one stage, with output as it comes, and adds up what passed and failed.
run()
{
  local begin=$SECONDS status stage_passed=0 stage_failed=0 bad all
  echo "==== $1"
  (
    set -e
    "$1"
  ) 2>&1 | tee "$log"
  status=${PIPESTATUS[0]}
  # "99% tests passed, 2 tests failed out of 643"
  while read -r bad all; do
    stage_failed=$((stage_failed + bad))
    stage_passed=$((stage_passed + all - bad))
  done < <(sed -nE 's/^[0-9]+% tests passed, ([0-9]+) tests? failed out of ([0-9]+)$/\1 \2/p' "$log")
  if [ "$status" -ne 0 ] && [ "$stage_failed" -eq 0 ]; then
    stage_failed=1
  elif [ $((stage_passed + stage_failed)) -eq 0 ]; then
    stage_passed=1
  fi
  passed=$((passed + stage_passed))
  failed=$((failed + stage_failed))
  times+=("$(printf '%-9s %3d:%02d  %4d passed, %d failed' "$1" \
    $(((SECONDS - begin) / 60)) $(((SECONDS - begin) % 60)) "$stage_passed" "$stage_failed")")
  echo "==== ${times[-1]}"
}

stages=("$@")
if [ $# -eq 0 ]; then
  stages=(packages format layers doxygen tests tidy asan tsan)
fi
for stage in "${stages[@]}"; do
  case $stage in
    packages | format | layers | doxygen | tests | tidy | asan | tsan) ;;
    *)
      echo "$0: $stage is not a stage" >&2
      exit 2
      ;;
  esac
done
for stage in "${stages[@]}"; do
  run "$stage"
done

printf '\n'
printf '%s\n' "${times[@]}"
printf 'total     %3d:%02d\n' $((SECONDS / 60)) $((SECONDS % 60))
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]

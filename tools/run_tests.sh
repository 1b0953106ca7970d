#!/usr/bin/env bash
# Passes the tests on a bare Debian 12: installs what is missing, then runs every check that a change must pass.
# Usage: tools/run_tests.sh [--quick | --long]
#   --quick  release build and its tests only
#   --long   also the whole test suite under the thread sanitizer, and each fuzzer for a minute
# Without a switch: format, static analysis, sanitizers, release tests; 15 minutes or less on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

mode=${1:-}
case "$mode" in
  "" | --quick | --long) ;;
  *) echo "run_tests.sh: unknown switch '$mode': expected --quick or --long" >&2; exit 2 ;;
esac

began=$(date +%s)
step() { printf '\n== %s (after %d s)\n' "$1" "$(($(date +%s) - began))"; }
build() { # preset, targets...
  local preset=$1
  shift
  cmake --preset "$preset" >/dev/null
  cmake --build --preset "$preset" ${1:+--target "$@"} -- --quiet
}

step "set-up"
bash tools/setup.sh test
[ "$mode" = --long ] && bash tools/setup.sh fuzz

if [ "$mode" != --quick ]; then
  step "format"
  bash tools/check_format.sh
fi

step "release build"
build release

if [ "$mode" != --quick ]; then
  step "static analysis"
  bash tools/check_tidy.sh build/release

  # The sanitizers see the code through the unit tests; the recall tests on whole sets would take them hours.
  step "address and undefined-behaviour sanitizers"
  build asan
  ctest --preset asan -j 2 -LE slow --quiet -O build/asan/ctest.log || { cat build/asan/ctest.log; exit 1; }
  tail -n 4 build/asan/ctest.log

  step "thread sanitizer"
  if [ "$mode" = --long ]; then
    build tsan
    ctest --preset tsan -j 2 -LE slow --quiet -O build/tsan/ctest.log || { cat build/tsan/ctest.log; exit 1; }
  else
    build tsan matcher_test
    ctest --preset tsan -j 2 -R 'Thread' --quiet -O build/tsan/ctest.log || { cat build/tsan/ctest.log; exit 1; }
  fi
  tail -n 4 build/tsan/ctest.log
fi

if [ "$mode" = --long ]; then
  step "fuzzers, a minute each"
  build fuzz
  bash tools/run_fuzzers.sh 60
fi

step "release tests"
ctest --preset release -j 2

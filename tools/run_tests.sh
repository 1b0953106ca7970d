#!/usr/bin/env bash
# Passes the tests on a bare Debian 12: installs what is missing, then runs every check that a change must pass.
# Usage: tools/run_tests.sh [--quick | --long]
#   --quick  release build and its tests only
#   --long   every layer under every sanitizer and clang-tidy, each file for itself, each fuzzer for a minute, the
#            installation on a bare Debian (debootstrap), and the programs' faults 20 times each: two hours
# Without a switch: format, the address and undefined-behaviour sanitizers on what comes from the network and from the
# bus, release tests; 15 minutes or less on two cores, installation included.
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
# Runs test programs, each as two processes, so that what its tests share is made but twice; quietly unless one fails.
run_tests() { # build directory, tests that are left out (as --gtest_filter has them), programs (none: all)...
  local dir=$1 without=$2 program log shard running
  shift 2
  local programs=("$@")
  [ $# -gt 0 ] || mapfile -t programs < <(basename -a "$dir"/bin/*_test)
  for program in "${programs[@]}"; do
    log=$dir/$program
    running=()
    for shard in 0 1; do
      GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=$shard "$dir/bin/$program" --gtest_brief=1 --gtest_filter="-$without" \
        >"$log.$shard.log" 2>&1 &
      running+=($!)
    done
    for shard in 0 1; do
      wait "${running[$shard]}" || { cat "$log.$shard.log"; exit 1; }
      echo "$program: $(grep -E '^\[==========\].*ran' "$log.$shard.log")"
    done
  done
}
# The program, instrumented for races, on the sample with more threads than cores.
run_threaded_sample() { # build directory
  local out=$1/threads
  mkdir -p "$out"
  "$1/bin/edgepose" train models/phantom/phantom.ply -o "$out/phantom.model" --threads 4 >/dev/null
  "$1/bin/edgepose" match "$out/phantom.model" --depth models/phantom/scene/depth.png \
    --intrinsics models/phantom/scene/camera.json --json --threads 4 >"$out/found.json"
  echo "train and match with 4 threads: no race"
}

step "set-up"
bash tools/setup.sh test
if [ "$mode" = --long ]; then bash tools/setup.sh fuzz deploy; fi

if [ "$mode" != --quick ]; then
  step "format"
  bash tools/check_format.sh
fi

step "release build"
build release

if [ "$mode" != --quick ]; then
  if [ "$mode" = --long ]; then
    step "clang-tidy"
    bash tools/check_tidy.sh --apart
  fi

  step "address and undefined-behaviour sanitizers"
  if [ "$mode" = --long ]; then
    build asan
    run_tests build/asan ""
  else
    build asan tests/messaging/all tests/bus/all tests/canopen/all
    run_tests build/asan "" messaging_test udpm_receiver_test bus_test canopen_test canopen_trace_test
  fi

  if [ "$mode" = --long ]; then
    step "thread sanitizer"
    build tsan tests/matcher/all tests/messaging/all service_test edgepose
    run_tests build/tsan "" matcher_test threads_test messaging_test udpm_receiver_test service_test
    run_threaded_sample build/tsan
  fi
fi

if [ "$mode" = --long ]; then
  step "fuzzers, a minute each"
  build fuzz
  bash tools/run_fuzzers.sh 60
  step "installation on a bare Debian, the confined daemon, the unit under systemd"
  bash tests/deploy/chroot_test.sh
fi

step "release tests"
ctest --preset release -j 2

if [ "$mode" = --long ]; then
  step "the arm's faults"
  bash tools/soak_faults.sh 20
fi

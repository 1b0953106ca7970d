#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy; every finding is an error) over the project's own sources, two units at a time.
# Usage: tools/check_tidy.sh [--apart] [FOLDER...]     folders: common matcher messaging files settings planning reporting bus canopen arm servoing calibration render evaluation daemon controller simulator experiment demo servo server client (all)
#   --apart  each file for itself, as it is compiled; three times as long
# Without it up to ten files of a folder are read as one unit: the Eigen and standard headers, which take nearly all
# the time, are then gone through once for the ten. The checks are the same.
set -euo pipefail
cd "$(dirname "$0")/.."
joined=ON
if [ "${1:-}" = --apart ]; then
  joined=OFF
  shift
fi
folders=("${@:-common matcher messaging files settings planning reporting bus canopen arm servoing calibration render evaluation daemon controller simulator experiment demo servo server client}")
read -ra folders <<<"${folders[*]}"

# Only for the compile commands: nothing is built here but the headers that are made.
build=build/tidy
cmake --preset release -B "$build" -DEDGEPOSE_TESTS=OFF -DCMAKE_UNITY_BUILD=$joined \
  -DCMAKE_UNITY_BUILD_BATCH_SIZE=10 >/dev/null
cmake --build "$build" --target edgepose_lcm_types -- --quiet
sources=("${folders[@]}")
if [ "$joined" = ON ]; then sources=("${folders[@]/#/$build/}"); fi
# The longest first, so that the two end together.
mapfile -t units < <(find "${sources[@]}" \( -name '*.cpp' -o -name 'unity_*.cxx' \) -size +0 -printf '%s %p\n' | sort -rn | cut -d' ' -f2)
[ ${#units[@]} -gt 0 ] || { echo "check_tidy.sh: no sources in ${folders[*]}" >&2; exit 2; }

# GCC's own switches in the compile commands mean nothing to clang.
printf '%s\0' "${units[@]}" |
  xargs -0 -n 1 -P 2 clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option 2> >(grep -v 'warnings\? .*generated\|warnings\? generated' >&2)
files=$(find "${folders[@]}" -name '*.cpp' | wc -l)
echo "$files files: clang-tidy found nothing"

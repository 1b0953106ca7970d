#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy; every finding is an error) over the project's own sources, two files at a time.
# Usage: tools/check_tidy.sh BUILD_DIR [FILE.cpp...]
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:?usage: tools/check_tidy.sh BUILD_DIR [FILE.cpp...]}
shift
files=("$@")
if [ ${#files[@]} -eq 0 ]; then
  mapfile -t files < <(find common matcher files render evaluation client -name '*.cpp' | sort)
fi
# GCC's own switches in the compile commands mean nothing to clang.
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P 2 clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option 2> >(grep -v 'warnings generated\|warning generated' >&2)
echo "${#files[@]} files: clang-tidy found nothing"

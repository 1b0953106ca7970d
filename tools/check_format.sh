#!/usr/bin/env bash
# Fails, and names the places, if a C++ file is not laid out as .clang-format says. --fix lays it out.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t files < <(find common matcher messaging files settings planning reporting bus canopen arm servoing calibration daemon simulator controller experiment demo servo render evaluation server client bench tests fuzz -name '*.h' -o -name '*.cpp' | sort)
if [ "${1:-}" = --fix ]; then
  clang-format -i "${files[@]}"
else
  clang-format --dry-run --Werror "${files[@]}"
  echo "${#files[@]} files are laid out as .clang-format says"
fi

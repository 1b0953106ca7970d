#!/usr/bin/env bash
# bench/plot_speed.sh draws the curves that a file has, and says so where there is none. Usage: plot_speed_test.sh SOURCE_DIR
set -euo pipefail
script=${1:?usage: plot_speed_test.sh SOURCE_DIR}/bench/plot_speed.sh
fail() { echo "FAILED: $1" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
header=curve,set,variant,x,median_ms,p99_ms,further_ms,correct_005_percent,correct_010_percent

printf '%s\n' "$header" >"$work/none.csv"
printf '%s\nmodels,a set,,1,10,12,,,\nmodels,a set,,2,19,25,,,\n' "$header" >"$work/models.csv"
code=0
bash "$script" "$work" "$work/none.csv" >"$work/out" 2>&1 || code=$?
[ "$code" -eq 2 ] || fail "a file without curves: exit code $code, expected 2"
[ "$(wc -l <"$work/out")" -eq 1 ] || fail "more or less than one line: $(cat "$work/out")"
grep -q 'none.csv: expected curves, found no line' "$work/out" || fail "$(cat "$work/out")"
bash "$script" "$work" "$work/none.csv" "$work/models.csv" >"$work/out"
[ "$(cat "$work/out")" = "$work/speed_models.png" ] || fail "$(cat "$work/out")"
[ -s "$work/speed_models.png" ] || fail "no picture"

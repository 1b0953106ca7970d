#!/usr/bin/env bash
# Usage: tools/run_fuzzers.sh [SECONDS [JOBS]]
# Runs each fuzzer of build/fuzz for SECONDS (default 600), JOBS (default 2) at a time. Build them first:
#   tools/setup.sh fuzz && cmake --preset fuzz && cmake --build --preset fuzz
# A finding stops the run; its input is left in build/fuzz/findings.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-600} jobs=${2:-2}
mkdir -p build/fuzz/findings
mapfile -t fuzzers < <(find build/fuzz/bin -type f -executable -name '*fuzz*' | sort)
[ ${#fuzzers[@]} -gt 0 ] || { echo "run_fuzzers.sh: no fuzzer in build/fuzz/bin; build the preset fuzz first" >&2; exit 2; }

fuzz_one() {
  local name corpus log
  name=$(basename "$1")
  corpus=build/fuzz/corpus/$name
  log=build/fuzz/$name.log
  mkdir -p "$corpus"
  local seeds=()
  [ -d "fuzz/corpus/$name" ] && seeds=("fuzz/corpus/$name")
  if ! "$1" -max_total_time="$2" -rss_limit_mb=4096 -artifact_prefix="build/fuzz/findings/$name-" \
       -print_final_stats=1 "$corpus" "${seeds[@]}" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "$name: FINDING, see build/fuzz/findings" >&2
    return 255
  fi
  echo "$name: $(grep -o 'number_of_executed_units: *[0-9]*' "$log" | tr -dc 0-9) runs in $2 s, no finding"
}
export -f fuzz_one
printf '%s\n' "${fuzzers[@]}" | xargs -P "$jobs" -I{} bash -c 'fuzz_one "$@"' _ {} "$seconds"

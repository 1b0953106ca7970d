#!/usr/bin/env bash
# Tries every fault of the arm again and again (docs/servo_faults.md): in simulated time, with the programs over a Unix bus,
# and with the programs on vcan0 in user-mode Linux. The tables that it prints are those of docs/servo_faults.md.
# Usage: tools/soak_faults.sh [REPETITIONS (100)] [BUILD/bin]      100: two hours; on a machine that does nothing else
set -euo pipefail
cd "$(dirname "$0")/.."
export EDGEPOSE_FAULT_REPETITIONS=${1:-100}
[[ $EDGEPOSE_FAULT_REPETITIONS =~ ^[1-9][0-9]*$ ]] || { echo "soak_faults.sh: expected a number of repetitions, found '$1'" >&2; exit 2; }
bin=${2:-build/release/bin}
[ -x "$bin/arm_process_test" ] || { echo "soak_faults.sh: no test programs in $bin: cmake --build --preset release" >&2; exit 2; }
failed=0
part() { # what, command...
  printf '\n== %s, %d times each\n' "$1" "$EDGEPOSE_FAULT_REPETITIONS"
  shift
  local log
  log=$(mktemp)
  "$@" 2>&1 | tee "$log" || failed=1
  if grep -q '^\[  SKIPPED \]' "$log"; then
    echo "soak_faults.sh: tests were skipped" >&2
    failed=1
  fi
  rm -f "$log"
}
part "in simulated time" "$bin/controller_test" --gtest_brief=1 --gtest_filter='Faults.*:*Wrong*'
part "programs, Unix bus" "$bin/arm_process_test" --gtest_brief=1 --gtest_filter='ProcessFaults.*'
part "programs on vcan0" bash tests/can_vm/can_vm_test.sh "$bin" "$(dirname "$bin")/can_vm"
exit "$failed"

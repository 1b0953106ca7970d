#!/usr/bin/env bash
# SocketCAN for real: socket_can_test in a guest that has it (run_in_vm.sh), then can_trace_test here, which has tshark
# decode what the first has recorded. Usage: can_vm_test.sh PROGRAM_FOLDER OUTPUT_FOLDER [GUEST'S ARGUMENT...]
# Exit code 77, with a line that says what is missing, where user-mode Linux cannot be had.
set -euo pipefail
programs=${1:?usage: can_vm_test.sh PROGRAM_FOLDER OUTPUT_FOLDER} out=${2:?usage: can_vm_test.sh PROGRAM_FOLDER OUTPUT_FOLDER}
shift 2
here=$(dirname "$0")
rm -rf "$out" # no session of an earlier run
mkdir -p "$out"
export EDGEPOSE_CAN_TRACES=$out
"$here/run_in_vm.sh" -o "$out" -t 200 -- "$programs/socket_can_test" --gtest_color=no "$@" | tee "$out/guest.log"
# Nothing in the guest may have been skipped: it has what the host lacks.
if grep -q '^\[  SKIPPED \]' "$out/guest.log"; then
  echo "can_vm_test.sh: the guest skipped tests" >&2
  exit 1
fi
[ $# -gt 0 ] || "$programs/can_trace_test" --gtest_color=no

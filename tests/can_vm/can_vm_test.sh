#!/usr/bin/env bash
# SocketCAN for real, in one boot of a guest that has it (run_in_vm.sh): socket_can_test, and arm_on_can_test, which runs
# edgepose-servo and edgepose-sim there. Then can_trace_test here, which has tshark decode what they have recorded.
# Usage: can_vm_test.sh PROGRAM_FOLDER OUTPUT_FOLDER [GUEST'S ARGUMENT...]
# EDGEPOSE_FAULT_REPETITIONS says how often each fault of the programs is tried (1).
# Exit code 77, with a line that says what is missing, where user-mode Linux cannot be had.
set -euo pipefail
usage="usage: can_vm_test.sh PROGRAM_FOLDER OUTPUT_FOLDER"
programs=${1:?$usage} out=${2:?$usage}
shift 2
here=$(dirname "$0")
rm -rf "$out" # no session of an earlier run
mkdir -p "$out"
export EDGEPOSE_CAN_TRACES=$out
# The programs' files are in the guest's memory: the host's disk may keep it waiting.
# shellcheck disable=SC2016 # expanded in the guest
both='socket=0 arm=0; "$0/socket_can_test" "$@" || socket=$?; TMPDIR=/run "$0/arm_on_can_test" "$@" || arm=$?; exit $((socket | arm))'
limit=$((240 + 60 * ${EDGEPOSE_FAULT_REPETITIONS:-1}))
"$here/run_in_vm.sh" -o "$out" -t "$limit" -m 640 -- bash -c "$both" "$programs" --gtest_color=no "$@" | tee "$out/guest.log"
# Nothing in the guest may have been skipped: it has what the host lacks.
if grep -q '^\[  SKIPPED \]' "$out/guest.log"; then
  echo "can_vm_test.sh: the guest skipped tests" >&2
  exit 1
fi
[ $# -gt 0 ] || "$programs/can_trace_test" --gtest_color=no

#!/usr/bin/env bash
# How late the arm controller's 5 ms cycles begin, beside the simulator that it talks to, moving to a hole again and again;
# and what the machine allows: how late a bare loop of a higher priority is on each processor in the same time.
# Usage: bench/cycle_jitter.sh [SECONDS] [BUILD/bin]      needs root, or user namespaces, for a network of its own
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-600}
bin=$(realpath "${2:-build/release/bin}")
if [ -z "${EDGEPOSE_OWN_NETWORK:-}" ]; then
  exec env EDGEPOSE_OWN_NETWORK=1 unshare -n bash "$0" "$seconds" "$bin"
fi
ip link set lo up
ip route add 224.0.0.0/4 dev lo
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null; wait; rm -rf "$folder"' EXIT
export EDGEPOSE_SERVO_SOCKET=$folder/servo.sock
"$bin/edgepose-sim" --model models/phantom/phantom.ply --plan models/phantom/drill_plan.json --publish poses --noise none \
  --keep-awake --bus "unix:$folder/bus" --told "$folder/told" 2>"$folder/sim.log" &
until [ -S "$folder/bus" ]; do sleep 0.1; done
"$bin/edgepose-servo" run --bus "unix:$folder/bus" --model vertebra_phantom --hand-eye "$folder/told/hand-eye.json" \
  --tool "$folder/told/tool.json" --log "$folder/arm.csv" --capture "$folder/arm.pcap" 2>"$folder/servo.log" &
until [ -S "$EDGEPOSE_SERVO_SOCKET" ]; do sleep 0.1; done
sleep 0.5
"$bin/edgepose_cycle_floor" "$seconds" &
floor=$!
end=$(($(date +%s) + seconds))
while [ "$(date +%s)" -lt "$end" ]; do
  for hole in left_pedicle_screw right_pedicle_screw; do
    "$bin/edgepose-servo" arm >/dev/null && sleep 0.5 && "$bin/edgepose-servo" go "$hole" >/dev/null || true
    for _ in $(seq 60); do
      state=$("$bin/edgepose-servo" status --json | grep -o '"state": "[a-z]*"' | cut -d'"' -f4)
      [ "$state" = converged ] || [ "$state" = fault ] && break
      [ "$(date +%s)" -lt "$end" ] || break
      sleep 1
    done
    "$bin/edgepose-servo" stop >/dev/null && sleep 0.7 && "$bin/edgepose-servo" reset >/dev/null || true
  done
done
wait "$floor"
"$bin/edgepose-servo" status --json | grep -E '"(cycles|cycles_missed|late_p50_s|late_p99.9_s|late_worst_s|took_p99.9_s|not_real_time)"'
grep -c "event=state state=fault" "$folder/servo.log" | sed 's/^/faults: /' || true

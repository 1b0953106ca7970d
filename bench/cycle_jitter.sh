#!/usr/bin/env bash
# How late the arm controller's 5 ms cycles begin, beside the simulator that it talks to, moving to a hole again and again;
# and what the machine allows: how late a bare loop of a higher priority is on each processor in the same time. A line for
# each minute: a machine that shares its processors with others is a different one from minute to minute.
# Usage: bench/cycle_jitter.sh [MINUTES] [BUILD/bin]      needs root, or user namespaces, for a network of its own
set -euo pipefail
cd "$(dirname "$0")/.."
minutes=${1:-10}
bin=$(realpath "${2:-build/release/bin}")
if [ -z "${EDGEPOSE_OWN_NETWORK:-}" ]; then
  exec env EDGEPOSE_OWN_NETWORK=1 unshare -n bash "$0" "$minutes" "$bin"
fi
ip link set lo up
ip route add 224.0.0.0/4 dev lo
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; wait; rm -rf "$folder"' EXIT
export EDGEPOSE_SERVO_SOCKET=$folder/servo.sock
servo() { "$bin/edgepose-servo" "$@" 2>>"$folder/commands.log"; }
field() { servo status --json | sed -n "s/^ *\"$1\": \"\\?\\([^\",]*\\)\"\\?,\\?$/\\1/p"; }

move_until() { # to one hole and to the other, until so many seconds have gone by
  while [ "$SECONDS" -lt "$1" ]; do
    for hole in left_pedicle_screw right_pedicle_screw; do
      { servo arm && sleep 0.5 && servo go "$hole"; } >/dev/null || true
      while [ "$SECONDS" -lt "$1" ]; do
        case "$(field state)" in converged | fault) break ;; esac
        sleep 1
      done
      { servo stop && sleep 0.7 && servo reset; } >/dev/null || true
    done
  done
}

minute() {
  "$bin/edgepose-sim" --model models/phantom/phantom.ply --plan models/phantom/drill_plan.json --publish poses \
    --noise none --keep-awake --bus "unix:$folder/bus" --told "$folder/told" 2>"$folder/sim.log" &
  local sim=$! controller floor
  until [ -S "$folder/bus" ]; do sleep 0.1; done
  "$bin/edgepose-servo" run --bus "unix:$folder/bus" --model vertebra_phantom --hand-eye "$folder/told/hand-eye.json" \
    --tool "$folder/told/tool.json" --log "$folder/arm.csv" --capture "$folder/arm.pcap" 2>"$folder/servo.log" &
  controller=$!
  until [ -S "$EDGEPOSE_SERVO_SOCKET" ]; do sleep 0.1; done
  sleep 0.5
  "$bin/edgepose_cycle_floor" 60 >"$folder/floor" &
  floor=$!
  SECONDS=0
  move_until 60
  wait "$floor"
  echo "$1 $(awk '{ if ($9 > worst) worst = $9 } END { printf "%.2f", 1e3 * worst }' "$folder/floor")" \
    "$(field cycles)" "$(field cycles_missed)" "$(field late_p50_s)" "$(field late_p99.9_s)" "$(field late_worst_s)" |
    awk '{ printf "| %d | %.2f | %d | %d | %.2f | %.2f | %.1f |\n", $1, $2, $3, $4, 1e3 * $5, 1e3 * $6, 1e3 * $7 }'
  kill "$controller" "$sim"
  wait "$controller" "$sim" || true
}

echo "| minute | bare loop, p99.9, ms | cycles | missed | late p50, ms | late p99.9, ms | worst, ms |"
echo "|---|---|---|---|---|---|---|"
for ((k = 1; k <= minutes; ++k)); do minute "$k"; done

#!/usr/bin/env bash
# How late the arm controller's 5 ms cycles begin, beside the simulator that it talks to, moving to a hole again and again;
# how late they end, with SYNC and set points sent; and what the machine allows: bare loops of a higher priority in the same
# time. Deadlines that were missed count as late. A line for each minute: a machine that shares its processors with others is
# a different one from minute to minute.
# Usage: bench/cycle_jitter.sh [MINUTES] [BUILD/bin]      needs root (SCHED_FIFO, and a network of its own)
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

await() { # socket, process
  for _ in $(seq 100); do
    [ ! -S "$1" ] || return 0
    kill -0 "$2" 2>/dev/null || break
    sleep 0.1
  done
  echo "cycle_jitter.sh: a program did not start:" >&2
  cat "$folder"/*.log >&2
  exit 1
}

minute() {
  rm -f "$folder/bus" "$EDGEPOSE_SERVO_SOCKET"
  "$bin/edgepose-sim" --model models/phantom/phantom.ply --plan models/phantom/drill_plan.json --publish poses \
    --noise none --keep-awake --bus "unix:$folder/bus" --told "$folder/told" 2>"$folder/sim.log" &
  local sim=$! controller floor
  await "$folder/bus" "$sim"
  "$bin/edgepose-servo" run --bus "unix:$folder/bus" --model vertebra_phantom --hand-eye "$folder/told/hand-eye.json" \
    --tool "$folder/told/tool.json" --log "$folder/arm.csv" --capture "$folder/arm.pcap" 2>"$folder/servo.log" &
  controller=$!
  await "$EDGEPOSE_SERVO_SOCKET" "$controller"
  sleep 0.5
  "$bin/edgepose_cycle_floor" 60 >"$folder/floor" &
  floor=$!
  SECONDS=0
  move_until 60
  wait "$floor"
  local figures bare
  bare=$(awk '$1 == "first" { first = $5 } $1 != "first" && $5 > worst { worst = $5 } END { print first, worst }' "$folder/floor")
  figures="$(field cycles) $(field cycles_missed) $(field late_p50_s) $(field late_p99.9_s) $(field late_worst_s) $(field ended_p99.9_s)"
  [ "$(wc -w <<<"$bare $figures")" -eq 8 ] || { echo "cycle_jitter.sh: no figures: '$bare' '$figures'" >&2; exit 1; }
  local refused
  refused=$(field not_real_time)
  echo "$1 $bare $figures $(grep -c 'event=state state=fault' "$folder/servo.log" || true)" |
    awk '{ printf "| %d | %.2f | %.2f | %d | %d | %.2f | %.2f | %.1f | %.2f | %d |\n", $1, $2, $3, $4, $5, 1e3 * $6, 1e3 * $7, 1e3 * $8, 1e3 * $9, $10 }'
  [ -z "$refused" ] || echo "NOT REAL TIME: $refused"
  kill "$controller" "$sim"
  wait "$controller" "$sim" || true
}

echo "| minute | bare loop, p99.9, ms: the first of the processors | the worst of them | cycles | missed | begun late, p50, ms | p99.9 | worst | ended late, p99.9, ms | faults |"
echo "|---|---|---|---|---|---|---|---|---|---|"
for ((k = 1; k <= minutes; ++k)); do minute "$k"; done

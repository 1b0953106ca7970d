#!/usr/bin/env bash
# Runs a command of this machine where Linux has CAN: in user-mode Linux, a Linux kernel that is a plain process
# (Debian's package user-mode-linux; no root, no virtualisation needed). Its root file system is this machine's, read only.
# Usage: tests/can_vm/run_in_vm.sh [-o FOLDER] [-t SECONDS] [-m MB] -- COMMAND [ARGUMENT...]
#   -o  the only folder that the command can write to, under its own name; $TMPDIR in there (default: one that is deleted)
#   -t  time for everything (120); -m  memory (256)
# The command sees the working folder, GTEST_* and EDGEPOSE_*, and EDGEPOSE_CAN_VM=1; modules can, can-raw, can-bcm, tbf and
# vcan (with echo: a frame is heard when it has left the queue) are loaded; interfaces it makes itself.
# Exit code: the command's; 124 if its time was up; 125 if the guest did not come up or died; 77, and a line that says
# what is missing, only if the package is neither installed nor can be fetched (into $EDGEPOSE_CAN_VM_CACHE).
set -euo pipefail

say() { echo "run_in_vm.sh: $*" >&2; }
out='' limit=120 memory=256
while getopts o:t:m: option; do
  case "$option" in
    o) out=$OPTARG ;;
    t) limit=$OPTARG ;;
    m) memory=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
[ "${1:-}" != -- ] || shift
[ $# -gt 0 ] || { say "expected a command after --"; exit 2; }
for number in "$limit" "$memory"; do
  [[ $number =~ ^[1-9][0-9]{0,5}$ ]] || { say "expected a number above zero, found '$number'"; exit 2; }
done

# Where the kernel and its modules are: installed, or fetched once; made aside and renamed, so that two may try at once.
installed() { [ -x "$1/usr/bin/linux.uml" ] && compgen -G "$1/usr/lib/uml/modules/*/kernel/net/can/can-raw.ko" >/dev/null; }
fetched=${EDGEPOSE_CAN_VM_CACHE:-${XDG_CACHE_HOME:-${HOME:-/tmp}/.cache}/edgepose/user-mode-linux}
fetch() {
  local parent aside
  parent=$(dirname "$fetched")
  mkdir -p "$parent" && aside=$(mktemp -d "$parent/.fetch_XXXXXX") || return
  (cd "$aside" && timeout 180 apt-get download -q user-mode-linux && dpkg-deb -x user-mode-linux_*.deb tree) >"$aside/log" 2>&1 &&
    { mv -T "$aside/tree" "$fetched" 2>/dev/null || installed "$fetched"; } ||
    say "$(grep -E '^E:' "$aside/log" | tail -n 1 || true)"
  rm -rf "$aside"
}
root=''
installed "$root" || { root=$fetched; installed "$root" || fetch; }
if ! installed "$root"; then
  say "SKIPPED, NOTHING TESTED on a CAN bus of the kernel: there is no user-mode-linux, and apt-get cannot fetch it;" \
    "apt-get install user-mode-linux"
  exit 77
fi
modules=$(echo "$root"/usr/lib/uml/modules/*/kernel)

keep=yes
[ -n "$out" ] || { out=$(mktemp -d); keep=no; }
mkdir -p "$out"
out=$(realpath "$out")
[[ $out != *[$',\n']* ]] || { say "the folder's name must have no comma or line break: $out"; exit 2; }
awake=()
private=$(mktemp -d "$out/.vm_XXXXXX") # what guest and host tell each other
trap 'kill "${awake[@]}" 2>/dev/null || true; rm -rf "$private"; [ "$keep" = yes ] || rm -rf "$out"' EXIT

{
  for name in $(compgen -e | grep -E '^(GTEST|EDGEPOSE)_' || true); do printf 'export %s=%q\n' "$name" "${!name}"; done
  printf 'cd %q\n' "$PWD"
  printf '%q ' "$@"
} >"$private/command.sh"
cat >"$private/init.sh" <<GUEST
#!/bin/bash
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/run LANG=C.UTF-8 EDGEPOSE_CAN_VM=1
mount -t proc proc /proc; mount -t sysfs sys /sys
mountpoint -q /dev || mount -t devtmpfs dev /dev
mkdir -p /dev/shm; mount -t tmpfs shm /dev/shm; mount -t tmpfs run /run
modules=$(printf %q "$modules")
# What insmod does (finit_module), with the perl that every Debian has.
load() { perl -e 'open my \$f, "<", "\$ARGV[0]" or die "\$ARGV[0]: \$!\n"; syscall(313, fileno(\$f), \$ARGV[1], 0) == 0 or die "\$ARGV[0]: \$!\n"' \\
  "\$modules/\$1.ko" "\${2:-}"; }
load net/can/can; load net/can/can-raw; load net/can/can-bcm; load drivers/net/can/dev/can-dev; load net/sched/sch_tbf
load drivers/net/can/vcan echo=1
# Frames go from socket to socket in soft interrupts, which a busy kernel leaves to this thread: not after the programs.
for one in /proc/[0-9]*; do [ "\$(<"\$one/comm")" != ksoftirqd/0 ] || chrt -f -p 70 "\${one#/proc/}"; done
echo -1 >/proc/sys/kernel/sched_rt_runtime_us # real time is not cut short: what the host takes counts as used
ip link set lo up
mount -t hostfs -o $(printf %q "$out") none $(printf %q "$out") # the one place that can be written
export TMPDIR=$(printf %q "$out")
read -r up _ </proc/uptime; echo "[guest] Linux \$(uname -r), up after \$up s"
bash $(printf %q "$private/command.sh") </dev/null 2>&1
echo \$? >$(printf %q "$private/status")
echo o >/proc/sysrq-trigger; sleep 60
GUEST
chmod +x "$private/init.sh"

# The guest's memory is a file; where /dev/shm is small (containers), in a folder.
ram=/dev/shm
free=$(df --output=avail -m "$ram" 2>/dev/null | tail -n 1)
[ "${free:-0}" -ge "$memory" ] || ram=$private
# Its processes are processes here as well: in a namespace, they end with it. (Who is not root would need one of users
# too, in which the guest's setuid programs belong to nobody.)
namespace=(unshare --pid --fork --kill-child) signal=KILL
"${namespace[@]}" true 2>/dev/null || { namespace=() signal=TERM; } # it ends them itself, if it is asked
# Each of the guest's system calls goes from process to process and back: three times as fast on one processor. And the
# guest keeps time, cycles of 5 ms: before other processes, where that is allowed.
processor=$(sed -n 's/^Cpus_allowed_list:.*[^0-9]\([0-9]*\)$/\1/p' /proc/self/status)
priority=(taskset -c "$processor" nice -n -20)
[ "$(id -u)" -eq 0 ] && "${priority[@]}" true 2>/dev/null || priority=(taskset -c "$processor")
"${priority[@]}" true 2>/dev/null || priority=()
# Processors that sleep wake late, on a virtual machine by milliseconds: kept awake by what gives way to all others.
for ((i = 0; i < $(nproc); ++i)); do
  chrt -i 0 bash -c 'while kill -0 "$0"; do for ((i = 0; i < 1000000; ++i)); do :; done; done' $$ 2>/dev/null &
  awake+=($!)
done
code=0
TMPDIR=$ram HOME=$private timeout --foreground --kill-after=5 -s "$signal" "$limit" "${namespace[@]}" "${priority[@]}" "$root/usr/bin/linux.uml" "mem=${memory}M" \
  rootfstype=hostfs root=/dev/root ro "init=$private/init.sh" con=null con0=null,fd:1 quiet loglevel=1 </dev/null || code=$?
[ ! -s "$private/status" ] || exit "$(<"$private/status")"
if [ "$code" -eq 124 ] || [ "$code" -eq 137 ]; then
  say "the command was not done after $limit s"
  exit 124
fi
say "the guest ended without a word (exit code $code of linux.uml)"
exit 125

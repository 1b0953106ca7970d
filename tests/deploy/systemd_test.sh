#!/usr/bin/env bash
# Boots the systemd of a Debian 12 in which edgepose is installed, in namespaces of its own, and tries the unit: what it
# restricts, and that the daemon works nevertheless. Usage: tests/deploy/systemd_test.sh ROOT   (chroot_test.sh makes one)
# Needs root and a version 2 cgroup hierarchy. Without controllers there, limits of memory and tasks are not tried.
set -euo pipefail
root=$(cd "${1:?usage: systemd_test.sh ROOT}" && pwd)
fail() {
  echo "FAILED: $1" >&2
  [ -z "${pid:-}" ] || inside journalctl --no-pager -u edgeposed -n 30 >&2 || true
  exit 1
}

if [ "${2:-}" = --boot ]; then # within the namespaces: becomes systemd
  mount --make-rprivate /
  ip link set lo up && ip route add 224.0.0.0/4 dev lo
  mount --bind "$root" "$root"
  mount -t proc proc "$root/proc"
  mount --bind "$root/proc/sys" "$root/proc/sys" && mount -o remount,bind,ro "$root/proc/sys" # the machine's own
  mount -t sysfs -o ro sysfs "$root/sys"
  mount -t cgroup2 cgroup2 "$root/sys/fs/cgroup"
  mount -t tmpfs -o mode=755 tmpfs "$root/dev"
  for device in null:3 zero:5 full:7 random:8 urandom:9; do
    mknod -m 666 "$root/dev/${device%:*}" c 1 "${device#*:}"
  done
  ln -s /proc/self/fd "$root/dev/fd"
  mkdir "$root/dev/shm" "$root/dev/pts"
  mknod -m 666 "$root/dev/tty" c 5 0
  mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"
  ln -s pts/ptmx "$root/dev/ptmx"
  mount -t tmpfs -o mode=755 tmpfs "$root/run"
  mount -t tmpfs tmpfs "$root/tmp"
  cd "$root"
  pivot_root . mnt
  exec env -i container=edgepose-test PATH=/usr/sbin:/usr/bin:/sbin:/bin chroot . sh -c 'umount -l /mnt &&
    exec /lib/systemd/systemd --system --unit=edgepose-test.target --log-target=journal --show-status=no'
fi

unified=$(awk '$3 == "cgroup2" {print $2; exit}' /proc/mounts)
[ -n "$unified" ] || { echo "SKIPPED: tests/deploy/systemd_test.sh: needs a cgroup2 mount" >&2; exit 0; }
mkdir -p "$root/etc/systemd/system/edgeposed.service.d" "$root/home/somebody"
cat >"$root/etc/systemd/system/edgepose-test.target" <<'UNIT'
[Unit]
Requires=basic.target edgeposed.service
After=basic.target
AllowIsolate=yes
UNIT
# The limit on addresses, too, which the unit leaves open; over a bare loopback multicast comes from 0.0.0.0.
printf '[Service]\nWatchdogSec=5\nTimeoutAbortSec=2\nIPAddressDeny=any\nIPAddressAllow=localhost multicast 0.0.0.0\n' \
  >"$root/etc/systemd/system/edgeposed.service.d/test.conf"
for unit in modprobe@.service systemd-networkd.service systemd-networkd-wait-online.service systemd-sysctl.service \
  sys-kernel-debug.mount sys-kernel-tracing.mount sys-kernel-config.mount sys-fs-fuse-connections.mount \
  dev-hugepages.mount dev-mqueue.mount systemd-firstboot.service systemd-machine-id-commit.service systemd-udevd.service; do
  ln -sf /dev/null "$root/etc/systemd/system/$unit"
done
: >"$root/etc/machine-id"
models=$(cd "$(dirname "$0")/../../models/phantom" && pwd)
cp -r "$models"/* "$root/home/somebody"
chmod -R a+rX "$root/home/somebody"
rm -rf "${root:?}"/var/lib/edgepose/*

group=$(mktemp -d "$unified/edgepose-test-XXXXXX")
clean_up() {
  [ -z "${namespaces:-}" ] || kill -KILL "$namespaces" 2>/dev/null || true
  wait 2>/dev/null || true # not that it was killed
  for _ in $(seq 50); do # its processes take a moment to end
    find "$group" -depth -type d -exec rmdir {} \; 2>/dev/null || true
    if [ ! -d "$group" ]; then break; fi
    sleep 0.1
  done
}
trap clean_up EXIT
# shellcheck disable=SC2016 # the inner shell's own
bash -c 'echo $$ >"$1/cgroup.procs" && exec unshare --cgroup --mount --pid --fork --kill-child --uts --ipc --net \
  bash "$2" "$3" --boot' sh "$group" "$0" "$root" &
namespaces=$!
for _ in $(seq 50); do
  pid=$(pgrep -P "$namespaces" || true)
  if [ -n "$pid" ] && [ "$(cat "/proc/$pid/comm")" = systemd ]; then break; fi
  sleep 0.1
done
[ -n "$pid" ] || fail "systemd did not start"
inside() { env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin nsenter -t "$pid" -m -u -i -n -p -C -r -w "$@"; }
value() { inside systemctl show -p "$1" --value edgeposed; }
until_is() { # what, expected, seconds
  for _ in $(seq $(($3 * 5))); do
    if [ "$(value "$1" 2>/dev/null)" = "$2" ]; then return; fi
    if [ "$(value ActiveState 2>/dev/null)" = failed ]; then fail "the unit failed"; fi
    sleep 0.2
  done
  fail "$1 is '$(value "$1")', not '$2' after $3 s"
}
ask() { # uid, gid, method, params
  printf '{"jsonrpc":"2.0","id":1,"method":"%s","params":%s}\n' "$3" "$4" |
    inside setpriv --reuid "$1" --regid "$2" --clear-groups socat -t 120 - UNIX-CONNECT:/run/edgepose/control.sock
}
demand() { # what, pattern: of standard input
  grep -qE "$2" || fail "$1: no $2"
  echo "$1: yes"
}

until_is ActiveState active 60
echo "READY under $(inside systemctl --version | head -n 1)"
main=$(value MainPID)
inside cat "/proc/$main/status" >"$root/var/tmp/status"
grep -E '^(Uid|CapEff|CapBnd|NoNewPrivs|Seccomp):' "$root/var/tmp/status"
demand "system calls are filtered" '^Seccomp:.*2' <"$root/var/tmp/status"
inside cat "/proc/$main/mountinfo" | demand "the system is read only" '^[0-9]+ [0-9]+ [0-9:]+ [^ ]+ / ro[, ]'
inside stat -c '%A %U %G %n' /run/edgepose /run/edgepose/control.sock /var/lib/edgepose
ask nobody edgepose status '{}' | demand "a member of the group may ask" '"ready":true'
! ask nobody nogroup status '{}' 2>/dev/null | grep -q ready || fail "others may ask"
ask nobody edgepose models.register '{"mesh":"/home/somebody/phantom.ply","plan":"/home/somebody/drill_plan.json"}' |
  demand "a mesh in a home is registered, in a child process" '"training_seconds"'
inside cp /home/somebody/phantom.ply /tmp/other.ply
ask nobody edgepose models.register '{"mesh":"/tmp/other.ply"}' | demand "one in /tmp is not seen" '"error".*no such file'
ask nobody edgepose detect '{"depth":"/home/somebody/scene/depth.png","intrinsics":"/home/somebody/scene/camera.json"}' |
  demand "the phantom is found" '"accepted":true'
sleep 3 # it hears its own messages of each second
ask nobody edgepose stats '{}' | demand "LCM is heard, from the allowed addresses only" '"datagrams":[1-9]'
inside systemctl reload edgeposed
sleep 1
inside journalctl --no-pager -u edgeposed | demand "reload reads the configuration again" 'event=reloaded'
inside kill -SEGV "$main"
until_is NRestarts 1 20
until_is ActiveState active 20
ask nobody edgepose status '{}' | demand "after a crash it is started again, with its model" '"active_models":1'
inside kill -STOP "$(value MainPID)"
until_is NRestarts 2 40
until_is ActiveState active 20
ask nobody edgepose status '{}' | demand "the watchdog does the same" '"active_models":1'
inside systemctl stop edgeposed
[ "$(value Result)" = success ] || fail "stop: $(value Result)"
echo "it ends when told: yes"
rm -f "$root/etc/systemd/system/edgeposed.service.d/test.conf"
inside systemd-analyze verify --man=no /usr/local/lib/systemd/system/edgeposed.service || fail "systemd-analyze verify"
inside systemd-analyze security --offline=true --no-pager /usr/local/lib/systemd/system/edgeposed.service | tail -n 1

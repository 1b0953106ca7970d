#!/usr/bin/env bash
# Installs edgepose as docker/Dockerfile does, by the same scripts, on a Debian 12 that has nothing else (debootstrap),
# and runs the daemon there as the container would: as its own user, without rights, on a read-only system, in a network
# of its own; then under systemd. Usage: tests/deploy/chroot_test.sh
#   EDGEPOSE_CHROOT=DIR  works in DIR, and leaves it there; what is installed in it already is not installed again
# Needs root, debootstrap and the network; says SKIPPED without. Half an hour on two cores from nothing.
set -euo pipefail
cd "$(dirname "$0")/../.."

skip() { echo "SKIPPED: tests/deploy/chroot_test.sh: $1" >&2; exit 0; }
fail() { echo "FAILED: $1" >&2; [ ! -s "$root/tmp/daemon.log" ] || tail -n 30 "$root/tmp/daemon.log" >&2; exit 1; }
[ "$(id -u)" -eq 0 ] || skip "needs root"
for program in debootstrap unshare ip setpriv; do
  command -v "$program" >/dev/null || skip "needs $program"
done
# Mounts, processes and network end with the script, and are nobody else's.
if [ "${1:-}" != --inside ]; then
  unshare --mount --mount-proc --pid --fork --kill-child true || skip "needs namespaces"
  exec unshare --mount --mount-proc --pid --fork --kill-child bash "$0" --inside
fi

if [ -n "${EDGEPOSE_CHROOT:-}" ]; then
  root=$EDGEPOSE_CHROOT
else
  root=$(mktemp -d /tmp/edgepose_chroot_XXXXXX)
  chmod 755 "$root" # the daemon's user goes through it
fi
clean_up() {
  jobs -p | xargs -r kill 2>/dev/null || true
  wait
  while read -r mounted; do umount -l "$mounted" 2>/dev/null || true; done < <(awk -v r="$root" 'index($2, r "/") == 1 {print $2}' /proc/mounts | tac)
  if grep -q " $root" /proc/mounts; then umount -l "$root"; fi
  [ -n "${EDGEPOSE_CHROOT:-}" ] || rm -rf --one-file-system "$root"
}
trap clean_up EXIT
in_root() { env -i HOME=/root PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin chroot "$root" "$@"; }
step() { printf '\n== %s (after %d s)\n' "$1" "$SECONDS"; }

step "a bare Debian 12"
if [ ! -e "$root/etc/debian_version" ]; then
  debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian >"$root.log" 2>&1 ||
    { tail -n 20 "$root.log" >&2; fail "debootstrap"; }
  rm -f "$root.log"
fi
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
mount -t proc proc "$root/proc"
mount -t tmpfs -o mode=755 tmpfs "$root/dev" # devices of its own: nothing of the machine's /dev is in reach
for device in null:3 zero:5 full:7 random:8 urandom:9; do
  mknod -m 666 "$root/dev/${device%:*}" c 1 "${device#*:}"
done
ln -s /proc/self/fd "$root/dev/fd"
mkdir "$root/dev/shm"

step "the Dockerfile's steps"
mkdir -p "$root/opt/edgepose"
tar -c --exclude=./build --exclude=./.git . | tar -x --no-same-owner -C "$root/opt/edgepose"
for command in "bash tools/setup.sh run" "bash tools/install.sh && bash docker/prepare.sh"; do
  grep -qF "RUN $command" docker/Dockerfile || fail "docker/Dockerfile has no step '$command'"
  in_root bash -c "cd /opt/edgepose && $command" </dev/null
done
in_root bash -c 'command -v socat || apt-get -q install -y --no-install-recommends socat' >/dev/null # for the test only

step "what is installed"
for file in usr/local/bin/edgepose usr/local/bin/edgeposed usr/local/bin/edgepose-servo usr/local/bin/edgepose-sim \
  usr/local/lib/systemd/system/edgeposed.service usr/local/lib/systemd/system/edgepose-servo.service \
  usr/local/lib/sysctl.d/60-edgepose.conf usr/local/lib/sysusers.d/edgepose.conf etc/edgepose/edgeposed.toml \
  usr/local/share/doc/edgepose/examples/edgeposed.toml usr/local/share/doc/edgepose/docs/service.md; do
  [ -f "$root/$file" ] || fail "$file is not there"
done
in_root edgepose --version
in_root edgeposed --version
in_root edgepose-servo --version
in_root edgepose-sim --help >/dev/null
in_root edgeposed --config /etc/edgepose/edgeposed.toml --check-config

step "the daemon, confined as in docker/compose.yaml"
rm -rf "${root:?}"/var/lib/edgepose/*
mount --bind "$root" "$root"
mount -t proc proc "$root/proc"
mount --bind "$root/var/lib/edgepose" "$root/var/lib/edgepose"
mount --bind "$root/run/edgepose" "$root/run/edgepose"
mount -t tmpfs tmpfs "$root/tmp"
mount -t tmpfs -o mode=755 tmpfs "$root/dev"
mknod -m 666 "$root/dev/null" c 1 3
mknod -m 666 "$root/dev/urandom" c 1 9
mount -o remount,bind,ro "$root"
chmod 755 "$root/tmp"
touch "$root/tmp/daemon.log"

run_confined() { # command...: as edgepose, no capability, no way to any, the limits of compose.yaml
  env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin EDGEPOSE_SOCKET=/run/edgepose/control.sock STATE_DIRECTORY=/var/lib/edgepose \
    chroot "$root" sh -c 'cd /opt/edgepose && exec setpriv --reuid edgepose --regid edgepose --init-groups \
    --no-new-privs --inh-caps=-all --bounding-set=-all prlimit --core=0 --nofile=4096 "$@"' sh "$@"
}
serve() {
  ip link set lo up && ip route add 224.0.0.0/4 dev lo
  run_confined edgeposed --config docker/edgeposed.toml 2>"$root/tmp/daemon.log" &
  local job=$! daemon
  for _ in $(seq 100); do
    if grep -q event=ready "$root/tmp/daemon.log"; then break; fi
    sleep 0.1
  done
  grep event=ready "$root/tmp/daemon.log" || fail "no READY"
  daemon=$(pgrep -x edgeposed)
  ! run_confined sh -c 'touch /usr/local/bin/x' 2>/dev/null || fail "the system can be written"
  grep -E '^(Uid|Cap|NoNewPrivs)' "/proc/$daemon/status"
  run_confined bash docker/healthcheck.sh || fail "/healthz"
  echo "/healthz: ok"
  ask models.register '{"mesh":"/opt/edgepose/models/phantom/phantom.ply","plan":"/opt/edgepose/models/phantom/drill_plan.json"}' |
    tee "$root/tmp/answer" | cut -c -300
  grep -q '"training_seconds"' "$root/tmp/answer" || fail "models.register"
  ask detect '{"depth":"/opt/edgepose/models/phantom/scene/depth.png","intrinsics":"/opt/edgepose/models/phantom/scene/camera.json"}' |
    tee "$root/tmp/answer" | cut -c -300
  grep -q '"accepted":true' "$root/tmp/answer" || fail "detect"
  kill -HUP "$daemon" && sleep 0.5
  grep event=reloaded "$root/tmp/daemon.log" || fail "SIGHUP"
  kill -TERM "$daemon"
  wait "$job" || fail "exit code $? after SIGTERM"
  [ -n "$(ls "$root"/var/lib/edgepose/phantom-*.model)" ] || fail "no model in the state folder"
  ! run_confined bash docker/healthcheck.sh 2>/dev/null || fail "/healthz of a daemon that has ended"
}
ask() { # method, params
  printf '{"jsonrpc":"2.0","id":1,"method":"%s","params":%s}\n' "$1" "$2" |
    run_confined socat -t 120 - UNIX-CONNECT:/run/edgepose/control.sock
}
export -f run_confined serve ask fail
export root
unshare --net bash -euo pipefail -c serve

step "the unit, under a systemd of its own"
mount -o remount,bind,rw "$root"
while read -r mounted; do umount -l "$mounted"; done < <(awk -v r="$root" 'index($2, r) == 1 {print $2}' /proc/mounts | tac)
in_root bash -c '[ -e /lib/systemd/systemd ] || apt-get -q install -y --no-install-recommends systemd' >/dev/null 2>&1
bash tests/deploy/systemd_test.sh "$root"

printf '\nThe installation, the confined daemon and the unit work (%d s)\n' "$SECONDS"

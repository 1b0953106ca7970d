#!/usr/bin/env bash
# Builds edgepose and installs it for the whole machine: all programs, the configuration of daemon and controller, their
# systemd units, user and sysctl file, documentation. Usage: tools/install.sh [PREFIX]
#   PREFIX   an absolute path, default /usr/local; the configuration goes to /etc/edgepose in any case, and is kept where
#            it is there
#   DESTDIR  of the environment is put before all paths, for packages; then no user is made
# Needs root, unless DESTDIR is a folder of one's own. On Debian 12 with nothing else installed.
set -euo pipefail
cd "$(dirname "$0")/.."
fail() { echo "install.sh: $*; tools/install.sh --help says more" >&2; exit 2; }

[ $# -le 1 ] || fail "expected at most one PREFIX, found $# arguments"
prefix=${1-/usr/local}
case "$prefix" in
  -h | --help) sed -n '2,/^set /{s/^# \{0,1\}//p}' tools/install.sh; exit 0 ;;
  -*) fail "unknown option '$prefix': expected a PREFIX such as /usr/local" ;;
  /*) ;;
  *) fail "expected an absolute path as PREFIX, such as /usr/local, found '$prefix'" ;;
esac

bash tools/setup.sh run
cmake --preset release -DEDGEPOSE_TESTS=OFF -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_SYSCONFDIR=/etc >/dev/null
cmake --build --preset release --target installed_programs -- --quiet
cmake --install build/release

[ -z "${DESTDIR:-}" ] || exit 0
if ! getent passwd edgepose >/dev/null; then
  useradd --system --user-group --home-dir /var/lib/edgepose --no-create-home --shell /usr/sbin/nologin edgepose
fi
if [ -d /run/systemd/system ]; then
  systemctl daemon-reload
  echo "Installed. Start it: sysctl --system && systemctl enable --now edgeposed"
fi

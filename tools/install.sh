#!/usr/bin/env bash
# Builds edgepose and installs it for the whole machine: both programs, the daemon's configuration, its systemd unit,
# user and sysctl file, documentation. Usage: tools/install.sh [PREFIX]
#   PREFIX   default /usr/local; the configuration goes to /etc/edgepose in any case, and is kept where it is there
#   DESTDIR  of the environment is put before all paths, for packages; then no user is made
# Needs root, unless DESTDIR is a folder of one's own. On Debian 12 with nothing else installed.
set -euo pipefail
cd "$(dirname "$0")/.."
prefix=${1:-/usr/local}

bash tools/setup.sh run
cmake --preset release -DEDGEPOSE_TESTS=OFF -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_SYSCONFDIR=/etc >/dev/null
cmake --build --preset release --target edgepose edgeposed -- --quiet
cmake --install build/release

[ -z "${DESTDIR:-}" ] || exit 0
if ! getent passwd edgepose >/dev/null; then
  useradd --system --user-group --home-dir /var/lib/edgepose --no-create-home --shell /usr/sbin/nologin edgepose
fi
if [ -d /run/systemd/system ]; then
  systemctl daemon-reload
  echo "Installed. Start it: sysctl --system && systemctl enable --now edgeposed"
fi

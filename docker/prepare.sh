#!/usr/bin/env bash
# Within the image, after tools/install.sh: what the daemon's user may write.
set -euo pipefail
cd "$(dirname "$0")/.."
install -d -o edgepose -g edgepose -m 0750 /var/lib/edgepose /run/edgepose
chown -R edgepose:edgepose build # the sample's results go there

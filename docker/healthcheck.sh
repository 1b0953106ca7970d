#!/usr/bin/env bash
# Exit code 0 if the daemon says that it is well: /healthz on the port of docker/edgeposed.toml. Usage: healthcheck.sh [PORT]
set -euo pipefail
exec 3<>"/dev/tcp/127.0.0.1/${1:-7668}"
printf 'GET /healthz HTTP/1.0\r\n\r\n' >&3
read -r -t 4 _ status _ <&3
[ "$status" = 200 ]

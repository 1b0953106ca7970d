#!/usr/bin/env bash
# The whole on a bare Debian 12, without hardware: installs what is missing, builds the programs, and brings a simulated
# arm's drill to a planned hole. Takes the options of edgepose-servo demo. Exit code 0 there, 1 not there, 2 bad input.
set -euo pipefail
cd "$(dirname "$0")/.."

bash tools/setup.sh run
cmake --preset release -DEDGEPOSE_TESTS=OFF >/dev/null
cmake --build --preset release --target edgepose edgeposed edgepose-sim edgepose-servo -- --quiet
exec build/release/bin/edgepose-servo demo "$@"

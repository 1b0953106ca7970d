#!/usr/bin/env bash
# The main job on a bare Debian 12: installs what is missing, builds edgepose, trains the sample's phantom and
# finds it in the sample's depth image. Exit code 0 found, 1 not found, 2 bad input.
set -euo pipefail
cd "$(dirname "$0")/.."

bash tools/setup.sh run
cmake --preset release -DEDGEPOSE_TESTS=OFF >/dev/null
cmake --build --preset release --target edgepose -- --quiet

edgepose=build/release/bin/edgepose
out=build/sample
mkdir -p "$out"
echo
"$edgepose" train models/phantom/phantom.ply -o "$out/phantom.model"
echo
"$edgepose" match "$out/phantom.model" --depth models/phantom/scene/depth.png \
  --intrinsics models/phantom/scene/camera.json --plan models/phantom/drill_plan.json \
  --mesh models/phantom/phantom.ply --overlay "$out/overlay.png"

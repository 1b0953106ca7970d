#!/usr/bin/env bash
# Installs what edgepose needs from Debian 12's own archive. Usage: tools/setup.sh [run|test|bench|fuzz|deploy]...
#   run    build and use the program (default)
#   test   run, and what the test command needs
#   bench  run, and the peers it is compared with (PCL: 600 MB to fetch)
#   fuzz   run, and clang's libFuzzer
#   deploy run, and what makes a bare Debian in a folder
# Does nothing, and needs no root, where everything is there already.
set -euo pipefail

run=(g++ cmake ninja-build libeigen3-dev libopencv-dev libembree-dev libcli11-dev nlohmann-json3-dev
     libtomlplusplus-dev libyaml-cpp-dev libpng-dev liblzf-dev libnanoflann-dev gnuplot-nox
     liblcm-dev liblcm-bin libsodium-dev zlib1g-dev
     libspdlog-dev libmicrohttpd-dev libsystemd-dev)
test=(git iproute2 clang-format clang-tidy libgtest-dev libgmock-dev liborocos-kdl-dev tshark)
# A Linux with CAN for the tests of SocketCAN (41 MB); Debian has it for this architecture, elsewhere they say so.
if [ "$(dpkg --print-architecture)" = amd64 ]; then test+=(user-mode-linux); fi
bench=(libpcl-dev libopencv-contrib-dev)
fuzz=(clang)
deploy=(debootstrap procps)

packages=("${run[@]}")
for part in "${@:-run}"; do
  case "$part" in
    run) ;;
    test) packages+=("${test[@]}") ;;
    bench) packages+=("${bench[@]}") ;;
    fuzz) packages+=("${fuzz[@]}") ;;
    deploy) packages+=("${deploy[@]}") ;;
    *) echo "setup.sh: unknown part '$part': expected run, test, bench, fuzz or deploy" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if [ "$(id -u)" -eq 0 ]; then
  as_root=()
elif command -v sudo >/dev/null; then
  as_root=(sudo)
else
  echo "setup.sh: these packages are missing and need root to install: ${missing[*]}" >&2
  exit 1
fi

echo "Installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
apt_get() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o Dpkg::Use-Pty=0 "$@" </dev/null; }
apt_get update >/dev/null
# One line a package is plenty: the whole output is shown only if it fails.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! apt_get install -y --no-install-recommends "${missing[@]}" >"$log" 2>&1; then
  cat "$log" >&2
  exit 1
fi

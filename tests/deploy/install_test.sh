#!/usr/bin/env bash
# tools/install.sh builds all that is installed, and refuses arguments that are no prefix before it does anything.
# Usage: tests/deploy/install_test.sh SOURCE_DIR BUILD_DIR
set -euo pipefail
cd "${1:?usage: install_test.sh SOURCE_DIR BUILD_DIR}"
build=${2:?usage: install_test.sh SOURCE_DIR BUILD_DIR}
fail() { echo "FAILED: $1" >&2; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Nothing is installed or built here, whatever the script does: it finds these instead.
mkdir "$work/bin"
printf '#!/bin/sh\necho "$@" >>"%s/calls"\n' "$work" | tee "$work/bin/cmake" "$work/bin/apt-get" "$work/bin/sudo" >/dev/null
chmod +x "$work"/bin/*
touch "$work/calls"
install_with() { PATH=$work/bin:$PATH DESTDIR=$work/root bash tools/install.sh "$@" >"$work/out" 2>"$work/err"; }

install_with --help || fail "--help ends with $?"
grep -q 'PREFIX' "$work/out" || fail "--help does not tell of PREFIX"
refused() { # words of the message, arguments
  local words=$1 code=0
  shift
  install_with "$@" || code=$?
  [ "$code" -eq 2 ] || fail "install.sh $*: exit code $code, expected 2"
  [ "$(wc -l <"$work/err")" -eq 1 ] || fail "install.sh $*: more or less than one line: $(cat "$work/err")"
  grep -q -- "$words" "$work/err" || fail "install.sh $*: no '$words' in: $(cat "$work/err")"
}
refused "'--prefix=/usr'" --prefix=/usr
refused "found 'opt'" opt
refused "found ''" ""
refused "2 arguments" /usr /opt
[ ! -s "$work/calls" ] || fail "something was done: $(cat "$work/calls")"

install_with "$work/prefix" || fail "$(cat "$work/err")"
targets=$(sed -n 's/.*--target \(.*\) -- .*/\1/p' "$work/calls")
[ -n "$targets" ] || fail "install.sh builds no targets: $(cat "$work/calls")"
# shellcheck disable=SC2086 # several words
commands=$(ninja -C "$build" -t commands $targets)
programs=$(grep -oP "TYPE EXECUTABLE FILES \"\Q$build\E/bin/\K[a-z-]+" "$build/deploy/cmake_install.cmake" | sort -u)
[ "$(wc -w <<<"$programs")" -ge 4 ] || fail "what is installed is not found in $build/deploy/cmake_install.cmake"
for program in $programs; do
  grep -q -- "-o bin/$program " <<<"$commands" || fail "install.sh installs $program but does not build it"
done
echo "built and installed: ${programs//$'\n'/, }"

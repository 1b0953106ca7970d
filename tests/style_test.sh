#!/usr/bin/env bash
# The layers hold: who may include whom (README, "Which file to read first"). Usage: style_test.sh SOURCE_DIR
set -uo pipefail
cd "${1:?usage: style_test.sh SOURCE_DIR}" || exit 2
faults=0

# forbid FOLDER PATTERN REASON: no source in FOLDER has an #include that matches PATTERN (extended regex, applied
# to what stands between the quotes or brackets).
forbid() {
  [ -d "$1" ] || return 0
  local hits
  hits=$(grep -rnE --include='*.h' --include='*.cpp' "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($2)" "$1")
  if [ -n "$hits" ]; then
    printf '%s\n   %s\n' "$hits" "$3"
    faults=1
  fi
}

# Each layer includes only layers below it.
forbid common '(matcher|messaging|files|settings|planning|reporting|render|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'common includes no other folder'
forbid matcher '(common|messaging|files|settings|planning|reporting|render|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'the matcher includes only matcher/'
forbid messaging '(files|settings|planning|reporting|render|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'messaging stands below these'
forbid settings '(messaging|planning|reporting|render|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'settings stands below these'
forbid planning '(messaging|settings|reporting|render|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'planning stands below these'
forbid reporting '(common|files|messaging|settings|planning|render|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'reporting knows the matcher only'
forbid files '(messaging|settings|planning|reporting|render|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'files stands below these'
forbid render '(messaging|settings|planning|reporting|evaluation|bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'render stands below these'
forbid evaluation '(bus|canopen|arm|servoing|calibration|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'evaluation stands below these'
forbid bus '(arm|servoing|calibration|matcher|messaging|files|settings|planning|reporting|render|evaluation|canopen|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'the bus knows common only'
forbid canopen '(arm|servoing|calibration|matcher|messaging|files|settings|planning|reporting|render|evaluation|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'CANopen knows common and the bus'
forbid arm '(messaging|files|settings|planning|reporting|bus|canopen|servoing|calibration|render|evaluation|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'arm stands below these'
forbid servoing '(messaging|files|settings|planning|reporting|bus|canopen|calibration|render|evaluation|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'servoing stands below these'
forbid calibration '(messaging|settings|planning|reporting|bus|canopen|render|evaluation|daemon|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'calibration stands below these'
forbid daemon '(matcher|messaging|files|settings|planning|reporting|render|evaluation|bus|canopen|arm|servoing|calibration|simulator|controller|experiment|demo|servo|client|server|bench|tests)/' 'daemon knows common only'
forbid simulator '(controller|experiment|servoing|client|server|bench|tests)/' 'the simulator knows nothing of whoever controls it'
forbid controller '(simulator|experiment|demo|servo|client|server|bench|tests)/' 'the controller never includes what simulates the world'
forbid client '(controller|simulator|experiment|demo|servo|server|bench|tests)/' 'client and server never include each other'
forbid server '(controller|simulator|experiment|demo|servo|client|bench|tests)/' 'client and server never include each other'

# The matcher is pure: besides its own headers, Eigen and the standard library (which has no '.' or '/' in a name).
outside=$(grep -rnE --include='*.h' --include='*.cpp' '^[[:space:]]*#[[:space:]]*include' matcher |
  grep -vE 'include[[:space:]]*("matcher/|<Eigen/|<[a-z_0-9]+>)')
if [ -n "$outside" ]; then
  printf '%s\n   the matcher knows Eigen and the standard library only\n' "$outside"
  faults=1
fi
forbid matcher '(fstream|filesystem|iostream|cstdio)>' 'the matcher neither reads nor writes files, nor prints'

# So is what moves an arm: state and time come in, motion comes out.
outside=$(grep -rnE --include='*.h' --include='*.cpp' '^[[:space:]]*#[[:space:]]*include' arm servoing |
  grep -vE 'include[[:space:]]*("(common/error\.h|matcher/(types|option_range)\.h|arm/|servoing/)|<Eigen/|<[a-z_0-9]+>)')
if [ -n "$outside" ]; then
  printf '%s\n   arm and servoing know Eigen and the standard library only\n' "$outside"
  faults=1
fi
for pure in arm servoing; do
  forbid "$pure" '(fstream|filesystem|iostream|cstdio|thread|mutex|chrono|ctime)>' 'arm and servoing have no files, threads or clock'
done

# PCL costs 10 s and 1 GB a translation unit: one, in the benchmark.
pcl=$(grep -rlE --include='*.h' --include='*.cpp' '#include <pcl/' . --exclude-dir=build | grep -v '^\./bench/pcl_[a-z_]*\.cpp$')
if [ -n "$pcl" ]; then
  printf '%s\n   PCL belongs in bench/pcl_*.cpp\n' "$pcl"
  faults=1
fi

# Headers are guarded, and included with their folder.
while IFS= read -r header; do
  head -n 1 "$header" | grep -q '^#pragma once$' || { echo "$header: does not start with #pragma once"; faults=1; }
done < <(find common matcher messaging daemon files settings planning reporting bus canopen arm servoing calibration simulator controller experiment demo servo render evaluation client bench server -name '*.h' 2>/dev/null)
bare=$(grep -rnE --include='*.h' --include='*.cpp' '^#include "[^/"]*"' common matcher messaging daemon files settings planning reporting bus canopen arm servoing calibration simulator controller experiment demo servo server render evaluation client bench 2>/dev/null)
if [ -n "$bare" ]; then
  printf '%s\n   include as "folder/file.h"\n' "$bare"
  faults=1
fi

[ "$faults" -eq 0 ] && echo "the layers hold"
exit "$faults"

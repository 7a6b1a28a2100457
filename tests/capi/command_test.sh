#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# command_test.sh TACTUS SOURCE_DIR LIBRARY: usage errors, versions and checks of the command. Runs are tested from Python.
set -u
tactus=$1
shelf=$2/examples/scenarios/shelf_3d.yaml
small=$2/tests/capi/small_shelf.yaml
failures=0

# expect STATUS WORD ARGUMENTS...: the command ends with this status and says the word.
expect() {
  status=$1 word=$2
  shift 2
  said=$("$tactus" "$@" 2>&1)
  got=$?
  if [ "$got" -ne "$status" ] || ! printf '%s' "$said" | grep -q -e "$word"; then
    echo "tactus $*: status $got, expected $status and '$word' in: $said"
    failures=$((failures + 1))
  fi
}

expect 0 'tactus [0-9]' --version
expect 0 'usage' --help
expect 2 'usage'
expect 2 'usage' dance
expect 2 'SCENARIO' run
expect 2 'unknown option' run x.yaml --dance 3
expect 2 'a value' run x.yaml --seed
expect 2 'a whole number' run x.yaml --seed -3
expect 2 'a number from 1' run x.yaml --trials 0
expect 2 'from 1 to 256' run x.yaml --jobs 0
expect 2 'expected --json' run x.yaml --resume
expect 2 'expected no --resume' run x.yaml --resume --json x.json --record y.json
expect 2 'greater than 0' run x.yaml --budget-seconds nan
expect 2 'six numbers' run x.yaml --true-pose 1,2,3
expect 2 'hierarchical or particles' run x.yaml --belief firm
expect 2 'at least 0' run x.yaml --stopping-distance -0.001
expect 2 'at least 0' run x.yaml --encoder-error inf
expect 2 'from 0 to 0.5' run x.yaml --missed-contacts 0.6
expect 2 'from 0 to 0.5' run x.yaml --false-contacts nan
expect 2 'can be replaced' run x.yaml --tables -
expect 2 'unknown option' run x.yaml --solvers rate,tbl
expect 2 'SCENARIO' compare --solvers rate,tbl
expect 2 'unknown option' compare x.yaml --solver rate
expect 2 'unknown option' compare x.yaml --true-pose 0,0,0,0,0,0
expect 2 'two or more' compare x.yaml
expect 2 'two or more' compare x.yaml --solvers rate
expect 2 'each solver once' compare x.yaml --solvers rate,tbl,rate
expect 2 'whole, voxels or poses' compare x.yaml --solvers rate,tbl --phase late
expect 2 'tactus compare: --resume: expected --json' compare x.yaml --solvers rate,tbl --resume
expect 2 '/nowhere.yaml' compare /nowhere.yaml --solvers rate,tbl
expect 2 '/nowhere.yaml' run /nowhere.yaml
expect 2 '/nowhere.yaml' check /nowhere.yaml
expect 2 'SCENARIO' export
expect 2 'expected a file' export x.yaml
expect 2 'unknown option' export x.yaml --solver rate
expect 2 'unknown option' evaluate x.yaml --pomdp x
expect 2 'a whole number' evaluate x.yaml --poses many
expect 2 'greater than 0' evaluate x.yaml --budget-expansions 0
expect 2 '/nowhere.yaml' evaluate /nowhere.yaml
expect 2 "poses: found 0" evaluate "$small" --poses 0
expect 2 "'guess'" evaluate "$small" --solver guess
expect 2 "can't be written" export "$small" --pomdp /nowhere/x.pomdp
expect 0 'Discount' export "$small" --poses 5 --pomdpx -
expect 0 'cost / optimum' evaluate "$small" --poses 5
expect 0 '"optimum": null' evaluate "$small" --poses 5 --most-beliefs 1 --json -
expect 0 'nothing wrong' check "$shelf"

# The library in a folder of its own, without the mesh importer: not the scenario's fault, and said once.
alone=$(mktemp -d "$PWD/alone_XXXXXX")
ln "$3" "$alone/libtactus.so.0"
LD_LIBRARY_PATH=$alone
export LD_LIBRARY_PATH
expect 2 "base.stl: found no mesh importer to read it with, expected $alone/tactus/tactus-import-mesh or" check "$shelf"
rm -r "$alone"
exit "$failures"

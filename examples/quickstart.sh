#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From a fresh clone on Debian 12 to a plugged-in socket: installs what is missing, builds, runs the shelf insertion, draws it.

source "$(dirname "${BASH_SOURCE[0]}")/setup.sh" bin/tactus

out=build/quickstart
mkdir -p "$out"

step "The shelf insertion: a socket somewhere in a shelf, found by touch"
status=0   # 1: the run went its way, but the plug is not in; that too is worth a look
build/release/bin/tactus run examples/scenarios/shelf_3d.yaml --seed 1 --record "$out/run.json" --json "$out/run-summary.json" || status=$?
((status <= 1)) || exit "$status"

step "Drawing the run"
"$python" examples/python/replay.py "$out/run.json" "$out"

step "Done. Look at
    $PWD/$out/run.png            a picture of the run
    $PWD/$out/replay.html        the run to replay, in any browser
    $PWD/$out/run-summary.json   its figures"
exit "$status"

# SPDX-License-Identifier: BSD-3-Clause
"""Runs the same trials on one thread and on two, in a release and in a debug build, and says whether they are the same."""
import argparse
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
WORK = ROOT / "build" / "determinism"


def with_threads(name, threads):
    """A copy of a scenario of the examples with so many threads; returns its file."""
    text = (ROOT / "examples" / "scenarios" / f"{name}.yaml").read_text()
    text = re.sub(r"(?m)^  threads: .*\n", "", text).replace("../models/", f"{ROOT}/examples/models/")
    file = WORK / f"{name}-{threads}.yaml"
    file.write_text(re.sub(r"(?m)^belief:\n", f"belief:\n  threads: {threads}\n", text))
    return file


def trials(build, threads, args):
    """What came of each trial, without the times that it took."""
    file = WORK / f"{build}-{threads}.json"
    subprocess.run([ROOT / "build" / build / "bin" / "tactus", "run", with_threads(args.scenario, threads), "--trials", str(args.trials), "--seed",
                    str(args.seed), "--solver", args.solver, "--belief", args.belief, "--budget-expansions", str(args.expansions), "--json", file],
                   check=True, stdout=subprocess.DEVNULL)
    return [{key: value for key, value in trial.items() if not key.endswith("_s")} for trial in json.loads(file.read_text())["trials"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenario", default="shelf_3d")
    parser.add_argument("--trials", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--expansions", type=int, default=3)
    parser.add_argument("--solver", default="brtdp-bel")
    parser.add_argument("--belief", default="particles")
    args = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    first, differing = None, 0
    for build in ("release", "debug"):
        for threads in (1, 2):
            found = trials(build, threads, args)
            first = first or found
            differing += found != first
            costs = ", ".join(f"{trial['cost_m']:.9g} in {trial['actions']} actions" for trial in found)
            print(f"{build:8} {threads} thread{'s' if threads > 1 else ' '}  {'the same' if found == first else 'OTHER'}: {costs}", flush=True)
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares solvers over the whole problem, on voxels alone and on poses alone; writes the paper's tables and its figure, beside its own
numbers, to build/paper.

Stop it at any time: started again with the same arguments, or with more trials, it goes on where it was. examples/paper_tables.sh builds
what it needs first."""

import argparse
import json
import pathlib
import re
import signal
import sys

import long_run
import paper_figure
from long_run import ROOT

SOLVERS = "brtdp-bel,rtdp-bel,rtdp-inad,tbl,frontier,rate"
TITLES = {"whole": "Whole problem", "poses": "Particle phase", "voxels": "Volumetric phase"}

# Of the paper, relative to its planner: cost, total planning time, planning calls, time per call.
PUBLISHED = {
    "whole": {"tbl": (2.12, 0.72, 1.36, 0.51), "frontier": (1.73, 0.66, 3.09, 0.21), "rtdp-inad": (1.29, 0.88, 1.15, 0.76)},
    "poses": {"tbl": (2.83, 0.92, 1.46, 0.63), "frontier": (2.36, 0.71, 2.79, 0.25)},
    "voxels": {"tbl": (1.94, 0.63, 1.34, 0.47), "frontier": (1.52, 0.65, 3.20, 0.20)},
}


# --- the comparisons

def command(asked, phase):
    return ["build/release/bin/tactus", "compare", f"examples/scenarios/{asked.scenario}.yaml", "--solvers", asked.solvers,
            "--phase", phase, "--belief", "hierarchical", "--trials", str(asked.trials), "--seed", str(asked.seed),
            "--budget-expansions", str(asked.expansions), "--jobs", str(asked.jobs), "--resume", "--json", str(results(asked, phase).resolve())]


def results(asked, phase):
    return asked.folder / f"{asked.scenario}_{phase}.json"


def compare(asked, phase):
    long_run.run(TITLES[phase], command(asked, phase), asked.folder / f"{asked.scenario}_{phase}.log")


# --- the tables

HEAD = """| planner | finished | by both | cost | paper | 95 % | planning time | paper | calls | paper | time a call | paper |
|---|---|---|---|---|---|---|---|---|---|---|---|
"""


def number(value):
    return "" if value is None else f"{value:.2f}"


def row(standing, published):
    low, high = standing["cost_ratio_low"], standing["cost_ratio_high"]
    measured = [standing[key] for key in ("cost_ratio", "planning_ratio", "calls_ratio", "time_per_call_ratio")]
    cost, *rest = [f"{number(here)} | {number(there)}" for here, there in zip(measured, published)]
    interval = "" if low is None else f"{low:.2f} to {high:.2f}"
    return (f"| {standing['solver']} | {standing['finished']} of {standing['trials']} | {standing['common']} | {cost} | {interval} | "
            f"{' | '.join(rest)} |\n")


def table(comparison):
    phase, summary = comparison["phase"], comparison["summary"]
    published = {"rtdp-bel": (1.0,) * 4, **PUBLISHED[phase]}
    rows = "".join(row(standing, published.get(standing["solver"], (None,) * 4)) for standing in summary)
    budget = [f"{key} {value}" for key, value in comparison["options"].items() if value is not None]
    return f"## {TITLES[phase]}\n\n{HEAD}{rows}\n{comparison['scenario']}, {', '.join(budget)}\n"


INTRODUCTION = """# The paper's tables, measured here

All but the counts is relative to {first}, in the paper to its own planner (rtdp-bel), over the poses that both finish: ratios of sums, 95 % intervals
of that of the costs. Arm, geometry and actions are not the paper's, which says little of them. Its third table is the row of rtdp-inad; rate
and brtdp-bel are not in it. In the particle phase all begin with the beliefs to which {first} had come on voxels.

"""


def write_tables(asked):
    """Of the results that are there, whole or not."""
    paths = [results(asked, phase) for phase in TITLES if results(asked, phase).exists()]
    comparisons = [json.loads(path.read_text()) for path in paths]
    path = asked.folder / f"{asked.scenario}.md"
    figure = paper_figure.section(asked.folder, asked.scenario)
    path.write_text(INTRODUCTION.format(first=asked.solvers.split(",")[0]) + "\n".join([table(c) for c in comparisons] + figure))
    print(f"\n{path}:\n\n{path.read_text()}", flush=True)


# --- all of it

def arguments(words=None):
    parser = argparse.ArgumentParser(description=re.sub(r"\s+", " ", __doc__.split("\n\n")[0]))
    parser.add_argument("--trials", type=int, default=4, metavar="N", help="poses, the same for all solvers (4)")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="of the first pose (1)")
    parser.add_argument("--solvers", default=SOLVERS, metavar="A,B,...", help=f"the one to measure by first ({SOLVERS})")
    parser.add_argument("--expansions", type=int, default=8, metavar="E",
                        help="beliefs expanded in a planning call (8: about what a second buys brtdp-bel on one core)")
    parser.add_argument("--scenario", default="sim_5d", metavar="NAME", help="of examples/scenarios (sim_5d, the paper's simulation)")
    parser.add_argument("--jobs", type=int, default=2, metavar="J", help="trials at a time (2)")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "paper", metavar="DIR", help="for results and tables (build/paper)")
    parser.add_argument("--only", choices=[*TITLES, "figure"], help="one table, or the figure, alone")
    return parser.parse_args(words)


def main():
    asked = arguments()
    asked.folder.mkdir(parents=True, exist_ok=True)
    print("Some minutes a trial on two free cores; how long a table still takes is told after each trial.\n"
          "Stop at any time (Ctrl-C): the same command goes on from there.", flush=True)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        if asked.only in (None, "figure"):
            paper_figure.measure(ROOT, asked.folder, asked.scenario)
        for phase in TITLES:
            if asked.only in (None, phase):
                compare(asked, phase)
    except KeyboardInterrupt:
        sys.exit("\nstopped; the same command goes on from here")
    finally:
        write_tables(asked)


if __name__ == "__main__":
    main()

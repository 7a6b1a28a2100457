#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs many simulated episodes of several settings, two at a time, and writes a table of them to build/study/table.md.

Stop it at any time: started again with the same arguments it goes on where it was. examples/study.sh builds what it needs first."""

import argparse
import json
import signal
import statistics
import sys
from typing import NamedTuple

import long_run
from long_run import ROOT, span

STUDY = ROOT / "build" / "study"
JOBS = 2


class Setting(NamedTuple):
    name: str  # of its files
    scenario: str
    options: list
    trials: int
    seconds: int  # that a trial takes one core, about, with 20 expansions


NOISE = ["--stopping-distance", "0.002", "--encoder-error", "0.0001", "--missed-contacts", "0.02", "--false-contacts", "0.02"]

SETTINGS = [
    Setting("shelf_3d", "shelf_3d", ["--belief", "particles"], 600, 60),
    Setting("base_4d", "base_4d", ["--belief", "particles"], 200, 45),
    Setting("sim_5d", "sim_5d", ["--belief", "particles"], 200, 120),
    Setting("shelf_3d_told", "shelf_3d_noise", ["--belief", "particles"], 100, 180),
    Setting("shelf_3d_untold", "shelf_3d", ["--belief", "particles", "--solver", "rtdp-bel", *NOISE], 100, 180),
]


# --- the runs

def command(setting, seed, expansions):
    return ["build/release/bin/tactus", "run", f"examples/scenarios/{setting.scenario}.yaml", *setting.options,
            "--trials", str(setting.trials), "--seed", str(seed), "--budget-expansions", str(expansions), "--jobs", str(JOBS),
            "--resume", "--json", f"build/study/{setting.name}.json"]


def run(setting, seed, expansions):
    long_run.run(f"{setting.name}: {setting.trials} trials", command(setting, seed, expansions), STUDY / f"{setting.name}.log")


# --- the table

HEAD = """| setting | trials | inserted | true pose kept | cost mean | median | max | actions | planning calls | planning s |
|---|---|---|---|---|---|---|---|---|---|
"""


def row(name, trials):
    begun = [trial for trial in trials if trial["cost_m"] is not None]

    def number(of, key, digits):
        return f"{of(trial[key] for trial in begun):.{digits}f}" if begun else "-"

    def share(key):
        count = sum(trial[key] for trial in trials)
        return f"{count} ({100 * count / len(trials):.1f} %)"

    costs = " | ".join(number(of, "cost_m", 2) for of in (statistics.mean, statistics.median, max))
    means = " | ".join(number(statistics.mean, key, 1) for key in ("actions", "planner_calls", "planning_s"))
    return f"| {name} | {len(trials)} | {share('inserted')} | {share('truth_kept')} | {costs} | {means} |\n"


def legend(setting, run):
    """What a row is of, as far as its name does not say it."""
    options = [f"{key} {value}" for key, value in run["summary"]["options"].items() if value is not None]
    return f"- {setting.name}: {run['scenario']}, {run['solver']}, {run['belief']}, {', '.join(options)}\n"


def write_table(path):
    """Of the results that are there, whole or not."""
    rows, notes = "", ""
    for setting in SETTINGS:
        results = STUDY / f"{setting.name}.json"
        run = json.loads(results.read_text()) if results.exists() else {"trials": []}
        if run["trials"]:
            rows += row(setting.name, run["trials"])
            notes += legend(setting, run)
    path.write_text(f"{HEAD}{rows}\nCosts in m + 0.05 m/rad + 0.005 m an action, over all trials; actions, calls and seconds are means of a trial, "
                    f"the seconds with {JOBS} trials at a time.\n\n{notes}")
    print(f"\n{path}:\n\n{path.read_text()}", flush=True)


# --- the study

def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--trials", type=int, metavar="N", help="of each setting (" + ", ".join(f"{s.name} {s.trials}" for s in SETTINGS) + ")")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="of the first trial (1)")
    parser.add_argument("--expansions", type=int, default=20, metavar="E", help="beliefs expanded in a planning call (20)")
    parser.add_argument("--only", choices=[setting.name for setting in SETTINGS], help="this setting alone")
    return parser.parse_args()


def main():
    asked = arguments()
    settings = [setting._replace(trials=asked.trials or setting.trials) for setting in SETTINGS if asked.only in (None, setting.name)]
    STUDY.mkdir(parents=True, exist_ok=True)
    print(f"{sum(setting.trials for setting in settings)} trials, {JOBS} at a time: about {span(sum(s.trials * s.seconds for s in settings) / JOBS)} on {JOBS} "
          "free cores with 20 expansions,\nless what is there already. How long a setting still takes is told after each trial.\n"
          "Stop at any time (Ctrl-C): the same command goes on from there.", flush=True)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        for setting in settings:
            run(setting, asked.seed, asked.expansions)
    except KeyboardInterrupt:
        sys.exit("\nstopped; the same command goes on from here")
    finally:
        write_table(STUDY / "table.md")


if __name__ == "__main__":
    main()

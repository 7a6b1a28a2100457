#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far the voxels' likelihoods can be trusted: what they forecast of actions against what happened, in tables and a diagram.

Over random true poses the voxel phase is played with either likelihood, to the hand-over. At each belief both likelihoods judge the same actions:
the one played, and what the one-step rules would do. Each is then tried in a world of its own. Stop it at any time: started again with the same
arguments, or with more trials, it goes on where it was. examples/reliability.sh builds what it needs first."""

import argparse
import json
import math
import os
import pathlib
import re
import signal
import sys
from typing import NamedTuple

import numpy as np

from paper_figure import with_belief  # first of ours: it says where the package is

import tactus

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "examples" / "scenarios"
LIKELIHOODS = ("paper", "calibrated")
RULES = ("tbl", "frontier", "rate")
PLANNERS, FORECASTS = 10 ** 6, 10 ** 7  # added to seeds: with a pose's own, the first pose drawn would be that one
MOST_ACTIONS = 12  # in the voxel phase of a trial
BINS = 10
Z95 = 1.959964


# --- an episode

def play(scenario, likelihood, seed, expansions):
    """The voxel phase at the true pose of this seed, planned with one likelihood: what was judged on the way, and how it ended."""
    belief = tactus.Belief(scenario, kind="hierarchical")
    planner = tactus.Planner(scenario, expansions=expansions, seed=seed + PLANNERS)
    rules = [tactus.Planner(scenario, solver=rule, expansions=1, seed=seed + PLANNERS) for rule in RULES]
    truth, played, judged = scenario.sample_pose(seed), [], []
    most = min(MOST_ACTIONS, scenario.limits["actions"])
    while belief.summary.phase == "voxels" and len(played) < most and (action := planner.query(belief)):
        others = {other.id: other for rule in rules if (other := rule.query(belief)) and other.id != action.id}
        draws = seed + (len(played) + 1) * FORECASTS
        seen = observe(scenario, truth, [*played, action])
        judged.append({"played": True, **judge(belief, action, draws, seen)})
        judged += [{"played": False, **judge(belief, other, draws, observe(scenario, truth, [*played, other]))} for other in others.values()]
        belief.step(action, seen)
        played.append(action)
    ended = "hand-over" if belief.summary.phase == "poses" else planner.reason or "limit of actions"
    return {"player": likelihood, "seed": seed, "ended": ended, "judged": judged}


def observe(scenario, truth, actions):
    """What the last of these actions meets."""
    world = tactus.World(scenario, truth)
    return [world.execute(action) for action in actions][-1]


def judge(belief, action, seed, seen):
    paper, calibrated = (belief.forecast(action, likelihood, seed) for likelihood in LIKELIHOODS)
    return {"kind": action.kind, "planned": action.contact_probability, "paper": contact(paper), "calibrated": contact(calibrated),
            "fell_back": bool(contact(paper) > 0 and np.array_equal(paper, calibrated)), "contact": bool(seen.contact)}


def contact(forecast):
    return min(1.0, float(forecast[:-1].sum()))


# --- all of them

def results(asked):
    return asked.folder / f"{asked.scenario.stem}.json"


def kept(asked):
    """The document with the episodes that are there."""
    path = results(asked)
    if not path.exists():
        return {"scenario": asked.scenario.stem, "expansions": asked.expansions, "episodes": []}
    document = json.loads(path.read_text())
    if document["expansions"] != asked.expansions:
        sys.exit(f"error: {path}: found --expansions {document['expansions']}, expected {asked.expansions}; move it away, or give it another --folder")
    return document


def keep(asked, document):
    document["episodes"].sort(key=lambda episode: (LIKELIHOODS.index(episode["player"]), episode["seed"]))
    beside = results(asked).with_suffix(".json.new")
    beside.write_text(json.dumps(document, indent=1) + "\n")
    os.replace(beside, results(asked))


def say(text):
    print(text, file=sys.stderr, flush=True)


def run(asked, document):
    there = {(episode["player"], episode["seed"]) for episode in document["episodes"]}
    todo = [(player, seed) for seed in range(asked.seed, asked.seed + asked.trials) for player in asked.players]
    say(f"{len(todo)} episodes of {asked.scenario.stem}, {len(there.intersection(todo))} are there. Stop at any time (Ctrl-C): the same command goes on from there.")
    text = asked.scenario.read_text()
    scenarios = {player: tactus.Scenario.parse(with_belief(text, "likelihood", player), asked.scenario.parent) for player in asked.players}
    for n, (player, seed) in enumerate(todo, 1):
        if (player, seed) not in there:
            episode = play(scenarios[player], player, seed, asked.expansions)
            document["episodes"].append(episode)
            keep(asked, document)
            say(f"    {player}, seed {seed}: {sum(a['played'] for a in episode['judged'])} actions, {episode['ended']}; {n} of {len(todo)} episodes")


# --- scores

class Bin(NamedTuple):
    low: float    # of the forecasts in it; it ends where the next begins
    count: int
    mean: float   # forecast
    share: float  # of its actions that met a contact


def bins(forecasts, happened):
    """Those that are not empty."""
    forecasts, happened = np.asarray(forecasts, float), np.asarray(happened, bool)
    index = np.minimum((forecasts * BINS).astype(int), BINS - 1)
    return [Bin(b / BINS, int(there.sum()), forecasts[there].mean(), happened[there].mean()) for b in range(BINS) if (there := index == b).any()]


def wilson(share, count):
    """The 95 % interval of a share seen in so many independent cases."""
    middle = (share + Z95 ** 2 / (2 * count)) / (1 + Z95 ** 2 / count)
    half = Z95 / (1 + Z95 ** 2 / count) * math.sqrt(share * (1 - share) / count + Z95 ** 2 / (4 * count ** 2))
    return max(0.0, middle - half), min(1.0, middle + half)


def brier(forecasts, happened):
    return float(np.mean((np.asarray(forecasts, float) - np.asarray(happened, float)) ** 2))


def calibration_error(forecasts, happened):
    """How far a bin's mean forecast is from its share, on average over all actions."""
    of = bins(forecasts, happened)
    return sum(b.count * abs(b.mean - b.share) for b in of) / sum(b.count for b in of)


# --- the page

INTRODUCTION = """# The likelihood of a contact on voxels: {scenario}

{expansions} expansions a plan, at most {most} actions a trial. *As planned*: what the planner expected of the action that it played, its motion alone. Else: what
a belief expects of the whole action, the way to the motion's start included, with poses drawn afresh. Contacts of a trial are not independent of
each other: the Wilson intervals are somewhat too narrow. A Brier score is to be compared with that of forecasting the overall share each time.

"""
ENDS_HEAD = "| played with | trials | actions | ended |\n|---|---|---|---|\n"
SCORES_HEAD = "| actions | likelihood | number | mean forecast | share with contact | Brier | of the share | calibration error |\n|---|---|---|---|---|---|---|---|\n"
BINS_HEAD = "| forecast | actions | mean forecast | share with contact | 95 % |\n|---|---|---|---|---|\n"


class Sample(NamedTuple):
    """Forecasts of one likelihood for some actions, and whether each met a contact."""

    actions: str
    likelihood: str
    forecasts: list
    happened: list


def samples(episodes):
    """What there is to score: each player's own actions as planned and by both likelihoods, then all actions by both."""
    def sample(name, likelihood, actions, key):
        return Sample(name, likelihood, [action[key] for action in actions], [action["contact"] for action in actions])

    found = []
    for player in LIKELIHOODS:
        played = [action for episode in episodes if episode["player"] == player for action in episode["judged"] if action["played"]]
        name = f"played with {player}"
        found += [sample(name, f"{player}, as planned", played, "planned"), *(sample(name, by, played, by) for by in LIKELIHOODS)]
    judged = [action for episode in episodes for action in episode["judged"]]
    found += [sample("all", by, judged, by) for by in LIKELIHOODS]
    return [s for s in found if s.forecasts]


def percent(share):
    return f"{100 * share:.1f} %"


def ends(episodes):
    def row(player, of):
        reasons = sorted({episode["ended"] for episode in of})
        counts = ", ".join(f"{reason} {sum(episode['ended'] == reason for episode in of)}" for reason in reasons)
        return f"| {player} | {len(of)} | {sum(a['played'] for episode in of for a in episode['judged'])} | {counts} |\n"

    return ENDS_HEAD + "".join(row(player, of) for player in LIKELIHOODS if (of := [e for e in episodes if e["player"] == player]))


def score_row(s):
    share = sum(s.happened) / len(s.happened)
    return (f"| {s.actions} | {s.likelihood} | {len(s.happened)} | {percent(sum(s.forecasts) / len(s.forecasts))} | {percent(share)} | "
            f"{brier(s.forecasts, s.happened):.3f} | {share * (1 - share):.3f} | {calibration_error(s.forecasts, s.happened):.3f} |\n")


def bin_row(b):
    low, high = wilson(b.share, b.count)
    return (f"| {100 * b.low:.0f} to {100 * b.low + 100 / BINS:.0f} % | {b.count} | {percent(b.mean)} | {percent(b.share)} | "
            f"{percent(low)} to {percent(high)} |\n")


def is_binned(s):
    return s.actions == "all" or "as planned" in s.likelihood


def page(asked, document):
    episodes = document["episodes"]
    scored = samples(episodes)
    judged = [action for episode in episodes for action in episode["judged"]]
    fallen = f"\nOf {len(judged)} forecasts of the calibrated likelihood {sum(a['fell_back'] for a in judged)} are the paper's, for want of feasible poses.\n"
    tables = [f"## {s.likelihood}: {s.actions}\n\n{BINS_HEAD}{''.join(map(bin_row, bins(s.forecasts, s.happened)))}" for s in scored if is_binned(s)]
    head = INTRODUCTION.format(scenario=document["scenario"], expansions=document["expansions"], most=MOST_ACTIONS)
    picture = f"![]({asked.scenario.stem}.png)\n"
    return head + "\n".join([ends(episodes), SCORES_HEAD + "".join(map(score_row, scored)) + fallen, picture, *tables])


def draw(scored, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(1, 2, figsize=(9, 4.5), dpi=150, layout="constrained", sharex=True, sharey=True)
    for axes, title, of in zip(panels, ("its own actions, as planned", "the same actions"),
                               ([s for s in scored if "as planned" in s.likelihood], [s for s in scored if s.actions == "all"])):
        axes.plot([0, 1], [0, 1], color="#888888", linewidth=1)
        for s in of:
            draw_sample(axes, s)
        axes.set(title=title, xlabel="forecast probability of a contact", xlim=(-0.02, 1.02), ylim=(-0.02, 1.02), aspect="equal")
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, loc="lower right")
    panels[0].set_ylabel("share with contact")
    figure.savefig(path)
    pyplot.close(figure)


def draw_sample(axes, s):
    player = s.likelihood.split(",")[0]
    style = {"paper": ("s--", "#9a5b13"), "calibrated": ("o-", "#2b6ca3")}[player]
    of = bins(s.forecasts, s.happened)
    shares = np.array([b.share for b in of])
    low, high = np.array([wilson(b.share, b.count) for b in of]).T
    axes.errorbar([b.mean for b in of], shares, yerr=[np.maximum(0, shares - low), np.maximum(0, high - shares)], fmt=style[0], color=style[1],
                  label=player, capsize=2)


def write_page(asked, document):
    """Of the episodes that are there."""
    if not document["episodes"]:
        return
    text = page(asked, document)
    results(asked).with_suffix(".md").write_text(text)
    draw(samples(document["episodes"]), results(asked).with_suffix(".png"))
    print(text, end="", flush=True)


# --- the command

def positive(text):
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"found '{text}', expected a whole number of 1 or more")
    return int(text)


def scenario_file(text):
    path = pathlib.Path(text) if text.endswith(".yaml") else SCENARIOS / f"{text}.yaml"
    if not path.is_file():
        raise argparse.ArgumentTypeError(f"found '{text}', expected a file or one of {', '.join(sorted(p.stem for p in SCENARIOS.glob('*.yaml')))}")
    return path.resolve()


def arguments(words=None):
    parser = argparse.ArgumentParser(description=re.sub(r"\s+", " ", __doc__.split("\n\n")[0]))
    parser.add_argument("--scenario", type=scenario_file, default="shelf_3d", metavar="NAME", help="of examples/scenarios, or a file (shelf_3d)")
    parser.add_argument("--trials", type=positive, default=100, metavar="N", help="true poses, the same for both players (100)")
    parser.add_argument("--seed", type=positive, default=1, metavar="S", help="of the first pose (1)")
    parser.add_argument("--expansions", type=positive, default=10, metavar="E", help="beliefs expanded in a planning call (10)")
    parser.add_argument("--likelihood", choices=[*LIKELIHOODS, "both"], default="both", help="to play with; both judge all actions (both)")
    parser.add_argument("--folder", type=pathlib.Path, default=ROOT / "build" / "reliability", metavar="DIR", help="for results and page (build/reliability)")
    asked = parser.parse_args(words)
    asked.players = LIKELIHOODS if asked.likelihood == "both" else (asked.likelihood,)
    return asked


def main(words=None):
    asked = arguments(words)
    asked.folder.mkdir(parents=True, exist_ok=True)
    document = kept(asked)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        run(asked, document)
    except KeyboardInterrupt:
        sys.exit("\nstopped; the same command goes on from here")
    finally:
        write_page(asked, document)


if __name__ == "__main__":
    main()

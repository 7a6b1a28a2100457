# SPDX-License-Identifier: BSD-3-Clause
"""The paper's figure: how long it takes to weigh actions, against the number of particles."""

import json
import os
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python_shim"))
import tactus

PARTICLES = [1000, 2000, 5000, 10000, 20000, 40000]
QUERIES = 3
PUBLISHED = {5000: 7.0, 40000: 60.0}  # s, for ten actions

NOTE = """Seconds to weigh actions against the number of poses that are looked at: the paper's for 10 actions ("over 60" at 40,000), here for all
actions that there are at the first belief of {scenario} (one belief expanded by tbl, the median of {queries}).
"""


def seconds_a_belief(root, scenario, particles):
    """To weigh every action at the prior with so many poses drawn from it; the motions themselves are there already."""
    folder = root / "examples" / "scenarios"
    text = (folder / f"{scenario}.yaml").read_text()
    loaded = tactus.Scenario.parse(with_belief(text, "particles", particles), folder)
    belief = tactus.Belief(loaded, kind="particles")
    planner = tactus.Planner(loaded, solver="tbl", expansions=1, seed=1)
    planner.query(belief)
    return statistics.median(query_seconds(planner, belief) for _ in range(QUERIES))


def query_seconds(planner, belief):
    planner.query(belief)
    return planner.statistics.seconds


def with_belief(text, key, value):
    """The scenario's text with another value for a key of its belief."""
    kept = [line for line in text.splitlines() if not line.strip().startswith(f"{key}:")]
    if "belief:" not in kept:
        kept.append("belief:")
    at = kept.index("belief:") + 1
    return "\n".join([*kept[:at], f"  {key}: {value}", *kept[at:]]) + "\n"


def measured(folder, scenario):
    """Seconds by number of particles, as far as they are known."""
    path = folder / f"{scenario}_particles.json"
    return {int(key): value for key, value in json.loads(path.read_text()).items()} if path.exists() else {}


def keep(folder, scenario, seconds):
    path = folder / f"{scenario}_particles.json"
    beside = path.with_suffix(".json.new")
    beside.write_text(json.dumps(seconds, indent=1) + "\n")
    os.replace(beside, path)


def measure(root, folder, scenario):
    seconds = measured(folder, scenario)
    print(f"\n==> Time against number of particles, {len(PARTICLES)} points; {len(seconds)} are there", flush=True)
    for particles in PARTICLES:
        if particles not in seconds:
            seconds[particles] = seconds_a_belief(root, scenario, particles)
            keep(folder, scenario, seconds)
            print(f"    {particles} particles: {seconds[particles]:.2f} s", flush=True)


def draw(seconds, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6, 4), dpi=150, layout="constrained")
    axes.plot(list(PUBLISHED), list(PUBLISHED.values()), "s--", color="#9a5b13", label="paper: 10 actions")
    axes.plot(sorted(seconds), [seconds[n] for n in sorted(seconds)], "o-", color="#2b6ca3", label="here: all actions at a belief")
    axes.set(xlabel="particles", ylabel="seconds", xlim=(0, None), ylim=(0, None))
    axes.xaxis.set_major_formatter(lambda n, _: f"{n:,.0f}")
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path)
    pyplot.close(figure)


def section(folder, scenario):
    """Of the Markdown page: the picture, drawn, and its numbers; nothing if nothing is measured."""
    seconds = measured(folder, scenario)
    if not seconds:
        return []
    picture = folder / f"{scenario}_particles.png"
    draw(seconds, picture)
    rows = "".join(f"| {n:,} | {seconds[n]:.2f} | {PUBLISHED.get(n, '')} |\n" for n in sorted(seconds))
    note = NOTE.format(scenario=scenario, queries=QUERIES)
    return [f"## Time against number of particles\n\n![]({picture.name})\n\n{note}\n| particles | here | paper |\n|---|---|---|\n{rows}"]

# SPDX-License-Identifier: BSD-3-Clause
"""The paper's tables and its figure, made of results that are there."""

import json
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples" / "python"))
import paper_figure  # noqa: E402
import paper_tables  # noqa: E402


def standing(solver, cost, low, high):
    return {"solver": solver, "trials": 5, "finished": 5, "common": 4, "cost_ratio": cost, "cost_ratio_low": low, "cost_ratio_high": high,
            "planning_ratio": 0.5, "calls_ratio": 2.0, "time_per_call_ratio": 0.25}


def keep_results(folder, phase, *standings):
    document = {"scenario": "sim_5d", "phase": phase, "options": {"budget_seconds": None, "budget_expansions": 20}, "summary": standings}
    (folder / f"sim_5d_{phase}.json").write_text(json.dumps(document))


def test_measured_stands_beside_published(tmp_path):
    keep_results(tmp_path, "whole", standing("rtdp-bel", 1.0, 1.0, 1.0), standing("rate", 1.1, 0.9, 1.3), standing("tbl", 1.5, None, None))
    keep_results(tmp_path, "poses", standing("rtdp-bel", 1.0, 1.0, 1.0), standing("frontier", None, None, None))
    paper_tables.write_tables(paper_tables.arguments(["--folder", str(tmp_path)]))
    page = (tmp_path / "sim_5d.md").read_text()
    assert page.index("## Whole problem") < page.index("## Particle phase") and "## Volumetric" not in page
    assert "| rate | 5 of 5 | 4 | 1.10 |  | 0.90 to 1.30 | 0.50 |  | 2.00 |  | 0.25 |  |" in page
    assert "| tbl | 5 of 5 | 4 | 1.50 | 2.12 |  | 0.50 | 0.72 | 2.00 | 1.36 | 0.25 | 0.51 |" in page
    assert "| frontier | 5 of 5 | 4 |  | 2.36 |" in page
    assert "sim_5d, budget_expansions 20" in page


def test_it_compares_scenarios_that_are_there():
    asked = paper_tables.arguments(["--trials", "30"])
    for phase in paper_tables.TITLES:
        words = paper_tables.command(asked, phase)
        assert (ROOT / words[2]).exists() and "--resume" in words
        assert words[words.index("--phase") + 1] == phase and words[words.index("--trials") + 1] == "30"
    assert all(set(rows) <= set(asked.solvers.split(",")) for rows in paper_tables.PUBLISHED.values())


@pytest.mark.parametrize("text, expected", [
    ("belief:\n  delta: 5\n  particles: 120\nlimits: {}\n", "belief:\n  particles: 7\n  delta: 5\nlimits: {}\n"),
    ("limits: {}\n", "limits: {}\nbelief:\n  particles: 7\n"),
])
def test_a_scenario_with_another_number_of_particles(text, expected):
    assert paper_figure.with_belief(text, "particles", 7) == expected


def test_the_figure_is_measured_once_and_drawn(tmp_path, monkeypatch):
    asked_for = []
    monkeypatch.setattr(paper_figure, "seconds_a_belief", lambda root, scenario, particles: asked_for.append(particles) or particles / 1000)
    paper_figure.keep(tmp_path, "sim_5d", {1000: 3.5})
    for _ in range(2):
        paper_figure.measure(ROOT, tmp_path, "sim_5d")
    assert asked_for == [n for n in paper_figure.PARTICLES if n != 1000]
    (section,) = paper_figure.section(tmp_path, "sim_5d")
    assert "| 1,000 | 3.50 |  |" in section and "| 5,000 | 5.00 | 7.0 |" in section
    assert (tmp_path / "sim_5d_particles.png").read_bytes().startswith(b"\x89PNG")


def test_nothing_measured_is_no_figure(tmp_path):
    assert paper_figure.section(tmp_path, "sim_5d") == []


def test_a_belief_of_few_poses_is_weighed():
    assert paper_figure.seconds_a_belief(ROOT, "shelf_3d", 3) > 0

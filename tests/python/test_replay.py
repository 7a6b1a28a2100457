# SPDX-License-Identifier: BSD-3-Clause
"""The picture and the page of a run are made from any record, however little it says."""

import json
import pathlib
import re
import subprocess
import sys

import pytest

REPLAY = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python" / "replay.py"
CORNERS = [x for corner in ((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)) for x in corner]
FACES = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]


def record():
    """A tool that moves towards a target in three frames and touches it in the last."""
    bodies = [{"name": kind, "kind": kind, "vertices": CORNERS, "triangles": FACES} for kind in ("robot", "tool", "world", "target")]
    frames = [{"poses": [[0, 0, 0, 0, 0, 0, 1], [x, 0, 0, 0, 0, 0, 1], [1, 0, -0.2, 0, 0, 0, 1], [1, 0, 0, 0, 0, 0, 1]], "action": int(x > 0.5),
               "contact": x == 0.9} for x in (0.5, 0.7, 0.9)]
    belief = {"possibly_occupied": 2, "cells": 0, "bits": 1.0, "points": [[1, 0, 0], [1, 0.1, 0.1]]}
    steps = [{"kind": "sweep", "phase": "</script>", "contact": contact, "cost_m": 0.2, "planning_s": 1.0, "belief": belief} for contact in (False, True)]
    weighed = [{"kind": kind, "verdict": verdict, "value": 0.5, "lower_bound": 0.4, "motion_cost": 0.2, "information_bits": 1.5, "contact_probability": 0.6,
                "goal_probability": 0.0, "start": [0, 0, 0], "end": [0, 0.5, 0], "outcomes": [[1, 0.2, 0, 0, 0, 0.5, 0]]} for kind, verdict in
               (("poke", "unreachable"), ("sweep", "chosen"))]
    steps[0]["why"] = {"weighed": 40, "alternatives": weighed}
    return {"scenario": "small", "bodies": bodies, "true_pose": [1, 0, 0, 0, 0, 0, 1], "frames": frames, "steps": steps}


def bare():
    full = record()
    return {"bodies": full["bodies"], "frames": [{"poses": full["frames"][0]["poses"]}]}


def undefined_fields():
    full = record()
    full["steps"] = [dict.fromkeys(step) for step in full["steps"]]
    return full


@pytest.mark.parametrize("make", [record, bare, undefined_fields])
def test_a_record_becomes_a_picture_and_a_page(make, tmp_path):
    (tmp_path / "run.json").write_text(json.dumps(make()))
    subprocess.run([sys.executable, str(REPLAY), str(tmp_path / "run.json"), str(tmp_path / "out")], check=True)
    assert (tmp_path / "out" / "run.png").read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / "out" / "replay.html").read_text()
    assert page.count("</script>") == 1
    assert not re.search(r"(src|href)=|https?:", page)
    data = json.loads(re.search(r"^const run = (.*);$", page, re.MULTILINE).group(1))
    assert data["frames"] == len(make()["frames"])
    assert [body["kind"] for body in data["bodies"]] == ["robot", "tool", "world", "target"]


def test_the_page_says_what_an_action_was_chosen_from(tmp_path):
    (tmp_path / "run.json").write_text(json.dumps(record()))
    code = "import json, sys, replay; print(json.dumps(replay.page_data(replay.Run(json.load(open(sys.argv[1]))))['steps']))"
    printed = subprocess.run([sys.executable, "-c", code, str(tmp_path / "run.json")], check=True, capture_output=True, text=True, cwd=REPLAY.parent)
    explained, silent = json.loads(printed.stdout)
    assert explained["weighed"] == 40
    assert [(a["kind"], a["verdict"]) for a in explained["alternatives"]] == [("poke", "unreachable"), ("sweep", "chosen")]
    assert explained["alternatives"][1]["goal_probability"] == 0.0 and explained["alternatives"][1]["end"] == [0, 0.5, 0]
    assert "outcomes" not in explained["alternatives"][0]
    assert silent["alternatives"] == []


def test_the_contact_lies_between_tool_and_target(tmp_path):
    (tmp_path / "run.json").write_text(json.dumps(record()))
    code = "import json, sys, replay; print(replay.Run(json.load(open(sys.argv[1]))).contacts[0][1][0])"
    printed = subprocess.run([sys.executable, "-c", code, str(tmp_path / "run.json")], check=True, capture_output=True, text=True, cwd=REPLAY.parent)
    assert float(printed.stdout) == pytest.approx(1.0)

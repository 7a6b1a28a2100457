#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes a picture (run.png) and a page to replay (replay.html) of what `tactus run --record FILE` wrote: replay.py FILE [FOLDER].

The page is one file that needs no network. The record:
    scenario   its name
    bodies     [{name, kind: robot | tool | world | target, vertices: flat x y z in metres, triangles: flat indices}]
    frames     [{poses: a body each, x y z qx qy qz qw in the robot's base frame, action: index into steps, contact: bool}]
    steps      [{kind, phase, contact, cost_m, planning_s, belief: {points: [[x, y, z]], ...}, why}], after the action: cost and planning so far
               lower_bound, value: optional: of the plan that the action is from, what it may cost from there on at least, and what the solver expects
               why: optional: {weighed: motions in all, alternatives: [{kind, verdict, value, ...}]}, the best of what the action was chosen from
    prior      optional: the belief at the start, with the same keys
    inserted   optional: whether the run ended plugged in; else judged by its last action
"""

import base64
import json
import pathlib
import sys

import numpy as np

MOST_FRAMES, MOST_POINTS = 3000, 3000  # in the page: more are thinned out
SHOWN = ["possibly_occupied", "cells", "bits", "extent"]  # of a belief, in the page
WEIGHED = ["kind", "verdict", "value", "lower_bound", "motion_cost", "information_bits", "contact_probability", "goal_probability", "start", "end"]


def rotations(quaternions):
    """(n x 3 x 3) of (n x 4), x y z w."""
    x, y, z, w = np.asarray(quaternions, float).T
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]).transpose(2, 0, 1)


def moved(vertices, pose):
    return vertices @ rotations([pose[3:]])[0].T + pose[:3]


class Body:
    def __init__(self, record):
        self.name, self.kind = record.get("name", ""), record.get("kind", "world")
        self.vertices = np.array(record["vertices"], float).reshape(-1, 3)
        self.triangles = np.array(record["triangles"], int).reshape(-1, 3)


class Step:
    """An action and the belief after it; whatever the record leaves out is None."""

    def __init__(self, record, belief=None):
        self.kind, self.phase = record.get("kind") or "?", record.get("phase") or ""
        self.contact = bool(record.get("contact"))
        self.cost, self.planning = record.get("cost_m"), record.get("planning_s")
        self.belief = record.get("belief") or belief or {}
        why = record.get("why") or {}
        self.weighed, self.alternatives = why.get("weighed"), why.get("alternatives") or []
        self.points = np.array(self.belief.get("points") or [], float).reshape(-1, 3)
        room = np.maximum(np.ptp(self.points, axis=0), 0.005).prod() if len(self.points) else 0.0
        self.dot = float(np.clip(0.35 * np.cbrt(room / max(len(self.points), 1)), 0.0025, 0.010))  # radius in metres at which dots stay apart


class Run:
    """A record as arrays. `poses` is (frames x bodies x 7); `start` is the step before the first action."""

    def __init__(self, record):
        frames = record["frames"]
        if not frames or not record["bodies"]:
            raise ValueError("a record without frames or bodies shows nothing")
        self.scenario = record.get("scenario") or "run"
        self.bodies = [Body(body) for body in record["bodies"]]
        self.poses = np.array([frame["poses"] for frame in frames], float)
        self.action = np.array([frame.get("action") or 0 for frame in frames], int)
        self.contact = np.array([bool(frame.get("contact")) for frame in frames])
        self.start = Step({"kind": "start"}, record.get("prior"))
        self.steps = [Step(step) for step in record.get("steps") or []]
        self.inserted = record.get("inserted", bool(self.steps) and self.steps[-1].kind == "insertion" and not self.steps[-1].contact)
        self.contacts = self._contacts()

    def placed(self, frame, kinds):
        """(body, vertices in the base frame) of the bodies of these kinds."""
        return [(body, moved(body.vertices, self.poses[frame, i])) for i, body in enumerate(self.bodies) if body.kind in kinds]

    def _contacts(self, reach=0.05):
        """[(action, point)]: where the robot and the target are nearest, in each frame with a contact."""
        found = []
        for frame in np.flatnonzero(self.contact):
            targets, movers = self.placed(frame, {"target"}), self.placed(frame, {"tool", "robot"})
            if not targets or not movers:
                continue
            target = np.concatenate([vertices for _, vertices in targets])
            mover = np.concatenate([vertices for _, vertices in movers])
            mover = mover[((mover > target.min(0) - reach) & (mover < target.max(0) + reach)).all(1)]
            if len(mover):
                squared = (mover ** 2).sum(1)[:, None] + (target ** 2).sum(1) - 2 * mover @ target.T
                i, j = np.unravel_index(squared.argmin(), squared.shape)
                found.append((self.action[frame], (mover[i] + target[j]) / 2))
        return found


def packed(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, kind).tobytes()).decode()


def thinned(items, most):
    """At most so many, in their order; by chance, for every n-th of a grid would be stripes."""
    if len(items) <= most:
        return items
    return items[np.sort(np.random.default_rng(0).choice(len(items), most, replace=False))]


def frames_to_show(run):
    """All contacts, the end of every action, and as many of the others as fit."""
    last = np.flatnonzero(np.append(np.diff(run.action) != 0, True))
    return np.unique(np.concatenate([last, np.flatnonzero(run.contact), thinned(np.arange(len(run.poses)), MOST_FRAMES)]))


def page_data(run):
    """What the template reads; long arrays as base64 of little-endian numbers."""
    frames = frames_to_show(run)

    def step_data(step):
        return {"kind": step.kind, "phase": step.phase, "contact": step.contact, "cost": step.cost, "planning": step.planning,
                **{key: step.belief.get(key) for key in SHOWN}, "weighed": step.weighed,
                "alternatives": [{key: alternative.get(key) for key in WEIGHED} for alternative in step.alternatives],
                "dot": step.dot, "points": packed(thinned(step.points, MOST_POINTS), "<f4")}

    return {"scenario": run.scenario, "frames": len(frames), "poses": packed(run.poses[frames], "<f4"),
            "action": run.action[frames].tolist(), "contact": run.contact[frames].astype(int).tolist(),
            "bodies": [{"name": body.name, "kind": body.kind, "vertices": packed(body.vertices, "<f4"),
                        "triangles": packed(body.triangles, "<u4")} for body in run.bodies],
            "contacts": [[int(action), *np.round(point, 4).tolist()] for action, point in run.contacts],
            "start": step_data(run.start), "steps": [step_data(step) for step in run.steps]}


def write_page(run, path):
    template = pathlib.Path(__file__).with_name("replay_template.html").read_text(encoding="utf-8")
    data = json.dumps(page_data(run), separators=(",", ":")).replace("</", "<\\/")
    path.write_text(template.replace("/*RUN*/null", data), encoding="utf-8")


def main(arguments):
    if len(arguments) not in (1, 2):
        sys.exit("usage: replay.py RECORD [FOLDER]")
    from replay_picture import write_picture

    folder = pathlib.Path(arguments[1] if len(arguments) == 2 else ".")
    folder.mkdir(parents=True, exist_ok=True)
    run = Run(json.loads(pathlib.Path(arguments[0]).read_text(encoding="utf-8")))
    write_picture(run, folder / "run.png")
    write_page(run, folder / "replay.html")


if __name__ == "__main__":
    main(sys.argv[1:])

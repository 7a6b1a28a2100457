#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Finds a socket by touch and plugs in: shelf_loop.py SCENARIO SEED EXPANSIONS. Prints the same as shelf_loop.c."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python_shim"))
import tactus


def main(path, seed, expansions):
    scenario = tactus.Scenario.load(path)
    planner = tactus.Planner(scenario, seed=seed, expansions=expansions)
    belief = tactus.Belief(scenario)
    world = tactus.World(scenario, scenario.sample_pose(seed))  # your robot goes here

    for step in range(1, scenario.limits["actions"] + 1):
        action = planner.query(belief)
        if action is None:
            break  # planner.reason: the goal is reached, or nothing is worth trying
        seen = world.execute(action)
        belief.step(action, seen)
        known = belief.summary
        print(step, action.kind, "contact" if seen.contact else "free", known.possibly_occupied, "voxels", known.cells, "cells")

    print("inserted" if world.inserted else "not inserted")
    return 0 if world.inserted else 1


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: shelf_loop.py SCENARIO SEED EXPANSIONS")
    sys.exit(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))

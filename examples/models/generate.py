#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the models of the examples: python3 generate.py [FOLDER], by default beside this file. README.md describes them."""

import pathlib
import sys

import numpy as np

from arm import write_arm
from remesh import delaunay
from shapes import at_height, bore, circle, divided, face, rectangle, rounded_rectangle, skin, turned, wall, write_stl

PINS = [(-0.011, -0.004, 0.0025), (0.011, -0.004, 0.0025), (0.0, 0.009, 0.003)]  # x, y, radius in the tool frame; the last is earth
PIN_LENGTH, PIN_CHAMFER, PIN_SEGMENTS = 0.019, 0.0008, 24
HOLE_CLEARANCE, HOLE_DEPTH = 0.001, 0.024

PALM_RADIUS, PALM_TOP = 0.037, 0.095
JAW_BOTTOM, JAW_TOP = 0.118, 0.140
PLUG_FRONT = 0.160


def pin(x, y, radius):
    """Open where it stands on the front face of the plug."""
    foot, tip = circle(radius, PIN_SEGMENTS, (x, y)), circle(radius - PIN_CHAMFER, PIN_SEGMENTS, (x, y))
    top = PLUG_FRONT + PIN_LENGTH
    shaft = wall(foot, PLUG_FRONT, top - PIN_CHAMFER, step=0.003)
    return np.concatenate([shaft, skin([at_height(foot, top - PIN_CHAMFER), at_height(tip, top)]), face(tip, [], top, up=True)])


def tool():
    """Palm, two fingers, jaws around the plug, the plug and its pins, bottom up: one closed shell."""
    step = 0.006
    palm = circle(PALM_RADIUS, 40)
    fingers = [divided(rectangle(x, x + 0.011, -0.009, 0.009), step) for x in (-0.033, 0.022)]
    jaws = divided(np.array([(0.021, -0.010), (0.034, -0.010), (0.034, 0.010), (0.021, 0.010), (0.021, 0.016), (-0.021, 0.016),
                             (-0.021, 0.010), (-0.034, 0.010), (-0.034, -0.010), (-0.021, -0.010), (-0.021, -0.016),
                             (0.021, -0.016)]), step)
    body = divided(rounded_rectangle(0.040, 0.030, 0.004, 3), step)
    feet = [circle(radius, PIN_SEGMENTS, (x, y)) for x, y, radius in PINS]
    shell = [
        face(palm, [], 0.0, False, step), wall(palm, 0.0, PALM_TOP, step), face(palm, fingers, PALM_TOP, True, step),
        *(wall(finger, PALM_TOP, JAW_BOTTOM, step) for finger in fingers),
        face(jaws, fingers, JAW_BOTTOM, False, step), wall(jaws, JAW_BOTTOM, JAW_TOP, step), face(jaws, [body], JAW_TOP, True, step),
        wall(body, JAW_TOP, PLUG_FRONT, step), face(body, feet, PLUG_FRONT, True, step / 2),
        *(pin(*p) for p in PINS),
    ]
    return delaunay(np.concatenate(shell))


def block(outline, holes, thickness, depth, step, hole_step):
    """A slab below z = 0 with blind holes from above: one closed shell."""
    return delaunay(np.concatenate([
        face(outline, [], -thickness, False, step), wall(outline, -thickness, 0.0, step), face(outline, holes, 0.0, True, step),
        *(wall(hole, -depth, 0.0, hole_step, inwards=True) for hole in holes),
        *(face(hole, [], -depth, True, hole_step) for hole in holes),
    ]))


def socket():
    """Built as a block with its front up, then laid with x into the wall. The plug comes in turned, so the pins' y changes sign."""
    step = 0.005
    outline = divided(rounded_rectangle(0.116, 0.072, 0.008, 3), step)
    holes = [bore(radius + HOLE_CLEARANCE, PIN_SEGMENTS, (x, -y)) for x, y, radius in PINS]
    front_up = block(outline, holes, 0.045, HOLE_DEPTH, step, hole_step=0.002)
    return turned(front_up, x=(0, -1, 0), y=(0, 0, 1), z=(-1, 0, 0))


def shelf():
    """A slab with one big rectangular hole, laid so that the hole opens towards the robot. Heights are along the slab's x."""
    step = 0.1
    outline = divided(rectangle(-0.07, 1.07, -0.52, 0.52), step)
    hole = divided(rectangle(-0.05, 1.05, -0.50, 0.50), step)
    upright = turned(block(outline, [hole], 0.37, 0.35, step, step), x=(0, 0, 1), y=(0, 1, 0), z=(-1, 0, 0))
    return upright + np.array([0.70, 0.0, 0.0])


def main(folder):
    write_arm(folder / "ur10e")
    write_stl(folder / "plug" / "plug.stl", tool())
    write_stl(folder / "socket" / "socket.stl", socket())
    write_stl(folder / "shelf" / "shelf.stl", shelf())


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent)

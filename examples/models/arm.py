# SPDX-License-Identifier: BSD-3-Clause
"""The UR10e: kinematics from the published Denavit-Hartenberg table, links as bent tubes in the frames of the maker's URDF."""

import math

import numpy as np

from shapes import bent_tube, lathe, mass_properties, turned, write_stl

HALF = math.pi / 2
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
NEGATIVE_Y = (0, -1, 0)

# joint: parent, child, xyz, rpy, range (+-), velocity, effort
REVOLUTE = {
    "shoulder_pan_joint": ("base_link_inertia", "shoulder_link", (0, 0, 0.1807), (0, 0, 0), 2 * math.pi, 2 * math.pi / 3, 330),
    "shoulder_lift_joint": ("shoulder_link", "upper_arm_link", (0, 0, 0), (HALF, 0, 0), 2 * math.pi, 2 * math.pi / 3, 330),
    "elbow_joint": ("upper_arm_link", "forearm_link", (-0.6127, 0, 0), (0, 0, 0), math.pi, math.pi, 150),
    "wrist_1_joint": ("forearm_link", "wrist_1_link", (-0.57155, 0, 0.17415), (0, 0, 0), 2 * math.pi, math.pi, 56),
    "wrist_2_joint": ("wrist_1_link", "wrist_2_link", (0, -0.11985, 0), (HALF, 0, 0), 2 * math.pi, math.pi, 56),
    "wrist_3_joint": ("wrist_2_link", "wrist_3_link", (0, 0.11655, 0), (-HALF, 0, 0), 2 * math.pi, math.pi, 56),
}
FIXED = {
    "base_link-base_link_inertia": ("base_link", "base_link_inertia", (0, 0, 0), (0, 0, math.pi)),
    "wrist_3-flange": ("wrist_3_link", "flange", (0, 0, 0), (0, -HALF, -HALF)),
    "flange-tool0": ("flange", "tool0", (0, 0, 0), (HALF, 0, HALF)),
}

ALUMINIUM, DARK = "0.75 0.77 0.80 1", "0.25 0.27 0.30 1"

# link: mesh, mass in kg (as published; the base's is an estimate), colour
BODIES = {
    "base_link_inertia": ("base", 4.0, DARK),
    "shoulder_link": ("shoulder", 7.369, ALUMINIUM),
    "upper_arm_link": ("upper_arm", 13.051, ALUMINIUM),
    "forearm_link": ("forearm", 3.989, ALUMINIUM),
    "wrist_1_link": ("wrist_1", 2.1, ALUMINIUM),
    "wrist_2_link": ("wrist_2", 1.98, ALUMINIUM),
    "wrist_3_link": ("wrist_3", 0.615, DARK),
}


def in_yz(tube):
    return turned(tube, Y, Z, X)


def in_xz(tube):
    return turned(tube, X, Z, NEGATIVE_Y)


def meshes():
    """Link shapes by mesh name, each one closed shell; joint faces of neighbours meet within a millimetre."""
    wrist = dict(bulge=0.006, inner=0.006, outer=0.035, step=0.04)
    return {
        "base": lathe([(0.048, 0), (0.092, 0), (0.095, 0.003), (0.095, 0.018), (0.086, 0.055), (0.078, 0.092), (0.076, 0.0993),
                       (0.038, 0.0993)], 48),
        "shoulder": in_yz(bent_tube([(0, -0.0817), (0, 0), (-0.0946, 0)], [0.0755] * 3, bulge=0.009)),
        "upper_arm": in_xz(bent_tube([(0, 0.0948), (0, 0.183), (-0.6127, 0.177), (-0.6127, 0.0975)], [0.0755, 0.0755, 0.060, 0.060],
                                     bulge=0.006)),
        "forearm": in_xz(bent_tube([(-0.57155, 0.106), (-0.57155, 0.0405), (0, 0.0400), (0, 0.1005)], [0.0465, 0.0465, 0.056, 0.058],
                                   bulge=0.002, rim=0.0015, inner=0.002)),
        "wrist_1": in_yz(bent_tube([(0, -0.0683), (0, 0), (-0.0666, 0)], [0.0465] * 3, **wrist)),
        "wrist_2": in_yz(bent_tube([(0.0679, 0), (0, 0), (0, -0.0534)], [0.0465] * 3, **{**wrist, "inner": 0.003})),
        "wrist_3": lathe([(0.022, -0.0489), (0.0435, -0.0489), (0.045, -0.0474), (0.045, -0.027), (0.045, -0.007), (0.038, 0),
                          (0.019, 0)], 36),
    }


def numbers(values):
    return " ".join(repr(float(value)) if value else "0" for value in values)


def origin(xyz, rpy):
    return f'<origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/>'


def bare_link(name):
    return f'  <link name="{name}"/>\n'


def link(name, triangles):
    mesh, mass, colour = BODIES[name]
    centre, inertia = mass_properties(triangles, mass)
    centre, inertia = np.round(centre, 4) + 0.0, np.round(inertia, 5) + 0.0  # no negative zeros
    geometry = f'<geometry><mesh filename="meshes/{mesh}.stl"/></geometry>'
    entries = " ".join(f'i{"xyz"[i]}{"xyz"[j]}="{inertia[i, j]:.5f}"' for i in range(3) for j in range(i, 3))
    return f"""  <link name="{name}">
    <inertial><mass value="{mass}"/>{origin(centre, (0, 0, 0))}
      <inertia {entries}/></inertial>
    <visual>{geometry}<material name="{mesh}"><color rgba="{colour}"/></material></visual>
    <collision>{geometry}</collision>
  </link>
"""


def fixed_joint(name):
    parent, child, xyz, rpy = FIXED[name]
    return f"""  <joint name="{name}" type="fixed">
    <parent link="{parent}"/><child link="{child}"/>{origin(xyz, rpy)}
  </joint>
"""


def revolute_joint(name):
    parent, child, xyz, rpy, limit, velocity, effort = REVOLUTE[name]
    return f"""  <joint name="{name}" type="revolute">
    <parent link="{parent}"/><child link="{child}"/>{origin(xyz, rpy)}
    <axis xyz="0 0 1"/>
    <limit lower="{-limit!r}" upper="{limit!r}" velocity="{velocity!r}" effort="{effort}"/>
  </joint>
"""


def urdf(solids):
    links = [link(name, solids[BODIES[name][0]]) for name in BODIES]
    parts = [bare_link("base_link"), *links, bare_link("flange"), bare_link("tool0"),
             *(fixed_joint(name) for name in FIXED), *(revolute_joint(name) for name in REVOLUTE)]
    return ('<?xml version="1.0"?>\n<!-- SPDX-License-Identifier: BSD-3-Clause -->\n<!-- Written by examples/models/generate.py. -->\n'
            f'<robot name="ur10e">\n{"".join(parts)}</robot>\n')


def write_arm(folder):
    solids = meshes()
    for name, triangles in solids.items():
        write_stl(folder / "meshes" / f"{name}.stl", triangles)
    (folder / "ur10e.urdf").write_text(urdf(solids))

# SPDX-License-Identifier: BSD-3-Clause
"""A scenario: everything that does not change."""

import ctypes
import os
from dataclasses import dataclass

import numpy as np

from . import library
from .library import Object, ScenarioHandle, c_string, call, pointer, rows, struct, text, value, vector, whole

BODY_KINDS = {1: "robot", 2: "tool", 3: "world", 4: "target"}


@dataclass(frozen=True)
class Body:
    """A rigid body to draw: ``vertices`` (n x 3) in its own frame, m; ``triangles`` (m x 3) of their indices."""

    name: str
    kind: str
    vertices: np.ndarray
    triangles: np.ndarray


class Scenario(Object):
    """The robot, its tool, the static world, the target and where it may be, what may be done. Constant: threads may share one."""

    _destroy = "tactus_scenario_destroy"

    @classmethod
    def load(cls, path):
        """Reads a scenario file and all that it names. Takes seconds. Raises `BadInput` with everything that is wrong, `TaskImpossible`."""
        return cls(cls._made_by("tactus_scenario_load", ScenarioHandle, c_string(os.fsencode(path), "path")))

    @classmethod
    def parse(cls, yaml, base_dir="."):
        """The same from YAML text; its paths are relative to ``base_dir``."""
        return cls(cls._made_by("tactus_scenario_parse", ScenarioHandle, c_string(yaml.encode(), "yaml"),
                                c_string(os.fsencode(base_dir), "base_dir")))

    @property
    def name(self):
        return text(value("tactus_scenario_name", ctypes.c_char_p, self.handle))

    @property
    def dof(self):
        """The length of every joint vector."""
        return value("tactus_scenario_dof", ctypes.c_size_t, self.handle)

    @property
    def joint_names(self):
        return [text(value("tactus_scenario_joint_name", ctypes.c_char_p, self.handle, j)) for j in range(self.dof)]

    @property
    def joint_limits(self):
        """(dof x 3): lower and upper position, rad or m, and velocity, rad/s or m/s."""
        limits = np.empty((self.dof, 3))
        for j, row in enumerate(limits):
            numbers = [ctypes.c_double() for _ in row]
            call("tactus_scenario_joint_limits", self.handle, j, *map(ctypes.byref, numbers))
            row[:] = [number.value for number in numbers]
        return limits

    @property
    def start(self):
        """The configuration in which the robot starts (dof)."""
        return rows("tactus_scenario_start", self.handle)

    @property
    def costs(self):
        """What a motion costs: {"metre": of the tool frame, "radian": that it turns, "action": each}."""
        costs = struct(library.CostsStruct, "tactus_costs_init")
        call("tactus_scenario_costs", self.handle, ctypes.byref(costs))
        return {"metre": costs.metre, "radian": costs.radian, "action": costs.action}

    @property
    def limits(self):
        """When an episode is to be given up: {"actions", "travel": m of the tool frame, "seconds"}."""
        limits = struct(library.LimitsStruct, "tactus_limits_init")
        call("tactus_scenario_limits", self.handle, ctypes.byref(limits))
        return {"actions": limits.actions, "travel": limits.travel, "seconds": limits.seconds}

    def sample_pose(self, seed):
        """A pose of the target (7), drawn from the prior; the same for the same seed."""
        pose = np.empty(7)
        call("tactus_scenario_sample_pose", self.handle, whole(seed, "seed"), pointer(pose))
        return pose

    def save_tables(self):
        """Where the tool touches targets, as beliefs have worked it out so far, as bytes: for `restore_tables` in the next program."""
        return rows("tactus_scenario_save_tables", self.handle, dtype=np.uint8).tobytes()

    def restore_tables(self, data):
        """Takes in what was saved: answers are the same, and sooner there. Raises `BadInput`, `WrongScenario`."""
        array = np.frombuffer(bytes(data) or b"\0", np.uint8)
        call("tactus_scenario_restore_tables", self.handle, pointer(array), len(data))

    @property
    def bodies(self):
        """Links with a shape, the tool, the static world, the target: a list of `Body`."""
        count = value("tactus_scenario_body_count", ctypes.c_size_t, self.handle)
        return [self._body(b) for b in range(count)]

    def _body(self, b):
        return Body(text(value("tactus_scenario_body_name", ctypes.c_char_p, self.handle, b)),
                    BODY_KINDS[value("tactus_scenario_body_kind", ctypes.c_int32, self.handle, b)],
                    rows("tactus_scenario_body_vertices", self.handle, b, width=3),
                    rows("tactus_scenario_body_triangles", self.handle, b, width=3, dtype=np.int32))

    def body_poses(self, q, target_pose):
        """Where the bodies are (n x 7), base frame, with the robot at ``q`` (dof) and the target at ``target_pose`` (7)."""
        q, target_pose = vector(q, self.dof, "q"), vector(target_pose, 7, "target_pose")
        return rows("tactus_scenario_body_poses", self.handle, pointer(q), pointer(target_pose), width=7)


def check(path):
    """Everything that is wrong with a scenario file: a list of lines, empty if nothing is. Takes as long as loading."""
    room, count = 1 << 20, ctypes.c_size_t()
    findings = ctypes.create_string_buffer(room)
    call("tactus_scenario_check", c_string(os.fsencode(path), "path"), findings, room, ctypes.byref(count))
    return text(findings.value).splitlines()


def pose_from_rpy(x, y, z, roll, pitch, yaw):
    """The pose (7) at x y z (m), turned by roll pitch yaw (rad) about the fixed axes x, then y, then z."""
    pose = np.empty(7)
    call("tactus_pose_from_rpy", pointer(vector([x, y, z, roll, pitch, yaw], 6, "xyzrpy")), pointer(pose))
    return pose

# SPDX-License-Identifier: BSD-3-Clause
"""A simulated robot, and a target at a pose that the planner does not know."""

import ctypes

import numpy as np

from . import library
from .action import Observation
from .library import Object, WorldHandle, call, fill, pointer, struct, value, vector


class World(Object):
    """Takes the place of the robot. Shares no contact code with the planner. One thread at a time."""

    _destroy = "tactus_world_destroy"

    def __init__(self, scenario, true_pose, *, fineness=None, seed=None, stopping_distance=None, encoder_error=None,
                 missed_contacts=None, false_contacts=None):
        """The robot at the scenario's start, the target at ``true_pose`` (7), anywhere in the prior.

        Contacts are looked for at ``fineness`` times finer steps than an action's waypoints. The last four are what the robot
        really does (m, m, and shares up to 0.5), by default what the scenario's ``sensing`` says; ``seed`` decides what
        chance does. Raises `InvalidArgument`, `TaskImpossible`."""
        options = struct(library.WorldOptions, "tactus_world_options_init")
        fill(options, fineness=fineness, seed=seed, stopping_distance=stopping_distance, encoder_error=encoder_error,
             missed_contacts=missed_contacts, false_contacts=false_contacts)
        pose = vector(true_pose, 7, "true_pose")
        super().__init__(self._made_by("tactus_world_create", WorldHandle, scenario.handle, pointer(pose),
                                       ctypes.byref(options)))
        self._dof = scenario.dof

    def execute(self, action):
        """Executes an action guarded: stops at the first contact that it feels and reports where, then goes back to the last free waypoint."""
        seen = Observation(False, np.zeros(self._dof)).as_struct()
        call("tactus_world_execute", self.handle, action.handle, ctypes.byref(seen))
        return Observation(seen.contact != 0, seen.array)

    @property
    def inserted(self):
        """Whether the tool got to the seated pose and touched nothing on the way, felt or not."""
        return bool(value("tactus_world_inserted", ctypes.c_int32, self.handle))

    @property
    def travelled(self):
        """What the tool frame has gone (m) and turned (rad) so far, retreats included."""
        metres, radians = ctypes.c_double(), ctypes.c_double()
        call("tactus_world_travelled", self.handle, ctypes.byref(metres), ctypes.byref(radians))
        return metres.value, radians.value

    @property
    def true_pose(self):
        """Where the target really is (7)."""
        pose = np.empty(7)
        call("tactus_world_true_pose", self.handle, pointer(pose))
        return pose

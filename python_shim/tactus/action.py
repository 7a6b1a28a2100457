# SPDX-License-Identifier: BSD-3-Clause
"""What the robot executes, and what it reports afterwards."""

import ctypes
from dataclasses import dataclass

import numpy as np

from . import library
from .library import ActionHandle, Object, call, lib, pointer, rows, struct


@dataclass
class Observation:
    """After an action: whether the robot stopped at a ``contact``, and the ``joints`` (dof) where it stopped, rad or m."""

    contact: bool
    joints: np.ndarray

    def as_struct(self):
        """For a call; the struct points into an array that it keeps alive."""
        made = struct(library.ObservationStruct, "tactus_observation_init")
        made.array = np.array(self.joints, np.float64).ravel()
        made.contact, made.joint_count, made.joints = int(self.contact), made.array.size, pointer(made.array)
        return made


class Action(Object):
    """A joint path from the robot's present configuration, to be executed guarded: stop at the first contact. Constant."""

    _destroy = "tactus_action_destroy"

    def __init__(self, handle, dof):
        super().__init__(handle)
        self._dof = dof
        self._properties = struct(library.ActionProperties, "tactus_action_properties_init")
        call("tactus_action_info", handle, ctypes.byref(self._properties))

    @property
    def kind(self):
        """"move", "turn", "sweep", "poke" or "insertion"."""
        return lib.tactus_action_kind_name(self._properties.kind).decode()

    @property
    def id(self):
        """Equal paths have equal ids."""
        return self._properties.id

    @property
    def length(self):
        """Metres that the tool frame goes if nothing is touched."""
        return self._properties.length

    @property
    def duration(self):
        """Seconds that it takes then."""
        return self._properties.duration

    @property
    def full_cost(self):
        """The cost of going all the way."""
        return self._properties.full_cost

    @property
    def expected_cost(self):
        """The cost of this action and of all that follows until the goal (on voxels the hand-over to poses), as the planner saw it."""
        return self._properties.expected_cost

    @property
    def contact_probability(self):
        """As the planner saw it."""
        return self._properties.contact_probability

    @property
    def waypoints(self):
        """The joint path (n x dof), rad or m."""
        return rows("tactus_action_waypoints", self.handle, width=self._dof)

    @property
    def times(self):
        """When each waypoint is passed (n), s from the start."""
        return rows("tactus_action_times", self.handle)

    def retreat(self, observation):
        """The index of the waypoint to which the robot goes back after a contact. Raises `StopOffPath`."""
        waypoint = ctypes.c_size_t()
        call("tactus_action_retreat", self.handle, ctypes.byref(observation.as_struct()), ctypes.byref(waypoint))
        return waypoint.value

    def save(self):
        """The action as bytes."""
        return rows("tactus_action_save", self.handle, dtype=np.uint8).tobytes()

    @classmethod
    def restore(cls, scenario, data):
        """The action that was saved, in the same scenario. Raises `BadInput`, `WrongScenario`."""
        array = np.frombuffer(bytes(data) or b"\0", np.uint8)
        handle = cls._made_by("tactus_action_restore", ActionHandle, scenario.handle, pointer(array), len(data))
        return cls(handle, scenario.dof)

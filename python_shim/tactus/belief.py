# SPDX-License-Identifier: BSD-3-Clause
"""The robot's configuration, and what is known of the target's pose."""

import ctypes
from dataclasses import dataclass

import numpy as np

from . import library
from .library import BeliefHandle, Object, call, lib, one_of, pointer, rows, struct, value, vector, whole

KINDS = {"hierarchical": 1, "particles": 2}
LIKELIHOODS = {"paper": 1, "calibrated": 2}
PHASES = {1: "voxels", 2: "poses"}


@dataclass(frozen=True)
class Summary:
    """A belief in numbers; six numbers of a pose are x y z (m) roll pitch yaw (rad)."""

    phase: str              # "voxels" or "poses"
    contradicted: bool      # the observations contradicted each other: some are doubted
    doubted: int            # how many
    observations: int
    contacts: int
    possibly_occupied: int  # voxels; 0 in the pose phase
    volume: float           # of these voxels, m^3
    cells: int              # of poses; 0 in the voxel phase
    bits: float             # entropy of the pose in steps of the task's tolerances: log2 of how many it spans
    mean: np.ndarray        # of the target's pose (6)
    extent: np.ndarray      # full widths (6)
    covariance: np.ndarray  # (6 x 6)


@dataclass(frozen=True)
class Mode:
    """A part of a belief that hangs together; six numbers of a pose are x y z (m) roll pitch yaw (rad)."""

    mass: float         # its share of the belief
    mean: np.ndarray    # of the target's pose (6)
    extent: np.ndarray  # full widths (6)


@dataclass(frozen=True)
class Event:
    """An action and what was felt."""

    kind: str      # of the action: "move", "turn", "sweep", "poke" or "insertion"
    contact: bool
    doubted: bool  # the likeliest explanation of all has it wrong
    q: np.ndarray  # where the robot stopped (dof), rad or m


class Belief(Object):
    """What is known so far. One thread at a time."""

    _destroy = "tactus_belief_destroy"

    def __init__(self, scenario, q=None, kind=None):
        """The target anywhere in the prior, the robot at ``q`` (dof; the scenario's start). ``kind``: "hierarchical" or "particles" (the scenario's).

        Raises `InvalidArgument`, `TaskImpossible` for a configuration that is not free."""
        options = struct(library.BeliefOptions, "tactus_belief_options_init")
        call("tactus_scenario_belief_options", scenario.handle, ctypes.byref(options))
        if kind is not None:
            options.kind = one_of(KINDS, kind, "kind")
        joints = scenario.start if q is None else vector(q, scenario.dof, "q")
        super().__init__(self._made_by("tactus_belief_create", BeliefHandle, scenario.handle, ctypes.byref(options),
                                       pointer(joints)))
        self._dof = scenario.dof

    @classmethod
    def _of(cls, handle, dof):
        belief = cls.__new__(cls)
        Object.__init__(belief, handle)
        belief._dof = dof
        return belief

    def clone(self):
        """An independent copy."""
        return self._of(self._made_by("tactus_belief_clone", BeliefHandle, self.handle), self._dof)

    __copy__ = clone

    def __deepcopy__(self, _):
        return self.clone()

    def step(self, action, observation):
        """Takes in what the robot reported after it executed ``action``. Some 0.1 s; the first steps of a wide prior some
        seconds, and late in a task, where it is proved that the tool is seated, up to 12 s in four dimensions and 26 s in
        five were seen on one thread (`belief.threads` shortens that). Ctrl-C is heard when it is over; the observation was taken in then.

        Raises `StopOffPath`, `InvalidArgument`, `WrongScenario`; then nothing has changed."""
        call("tactus_belief_step", self.handle, action.handle, ctypes.byref(observation.as_struct()))

    @property
    def configuration(self):
        """The robot's (dof), rad or m. Set it after a jog."""
        return rows("tactus_belief_configuration", self.handle)

    @configuration.setter
    def configuration(self, q):
        call("tactus_belief_set_configuration", self.handle, pointer(vector(q, self._dof, "q")))

    @property
    def summary(self):
        s = struct(library.SummaryStruct, "tactus_summary_init")
        call("tactus_belief_summary", self.handle, ctypes.byref(s))
        return Summary(PHASES[s.phase], s.health != 0, s.doubted, s.observations, s.contacts, s.possibly_occupied, s.volume,
                       s.cells, s.bits, np.array(s.mean), np.array(s.extent), np.array(s.covariance).reshape(6, 6))

    @property
    def voxels(self):
        """Centres of the voxels that the target may occupy (n x 3), base frame, m; none in the pose phase."""
        return rows("tactus_belief_voxels", self.handle, width=3)

    @property
    def poses(self):
        """Centres of the cells of poses that the target may have (n x 7); none in the voxel phase."""
        return rows("tactus_belief_poses", self.handle, width=7)

    @property
    def modes(self):
        """The parts of the belief that hang together, the heaviest first: a list of `Mode`; empty in the voxel phase."""
        return [Mode(row[0], row[1:7], row[7:13]) for row in rows("tactus_belief_modes", self.handle, width=13)]

    @property
    def history(self):
        """What was done and felt: a list of `Event`."""
        events = rows("tactus_belief_history", self.handle, width=3, dtype=np.int32)
        stops = rows("tactus_belief_stops", self.handle, width=self._dof)
        return [Event(lib.tactus_action_kind_name(int(kind)).decode(), bool(contact), bool(doubted), q)
                for (kind, contact, doubted), q in zip(events, stops)]

    @property
    def is_goal(self):
        """Whether the tool is seated now, for every pose that the target may still have."""
        return bool(value("tactus_belief_is_goal", ctypes.c_int32, self.handle))

    def contains(self, pose):
        """Whether the target may have this pose (7), as far as is known."""
        return bool(value("tactus_belief_contains", ctypes.c_int32, self.handle, pointer(vector(pose, 7, "pose"))))

    def forecast(self, action, likelihood="calibrated", seed=0):
        """What is expected of an action that begins where the robot is (waypoints + 1): the probability that the first contact is at each waypoint, and last that there is none.

        On voxels by the "paper"'s equations or the "calibrated" likelihood, the share of feasible poses (drawn with ``seed``); on poses
        their share. Raises `InvalidArgument`, `WrongScenario`."""
        return rows("tactus_belief_forecast", self.handle, action.handle,
                    one_of(LIKELIHOODS, likelihood, "likelihood"), whole(seed, "seed"))

    def save(self):
        """The whole belief as bytes."""
        return rows("tactus_belief_save", self.handle, dtype=np.uint8).tobytes()

    @classmethod
    def restore(cls, scenario, data):
        """The belief that was saved, in the same scenario. Raises `BadInput`, `WrongScenario`."""
        array = np.frombuffer(bytes(data) or b"\0", np.uint8)
        handle = cls._made_by("tactus_belief_restore", BeliefHandle, scenario.handle, pointer(array), len(data))
        return cls._of(handle, scenario.dof)

# SPDX-License-Identifier: BSD-3-Clause
"""A small finite search cut out of a scenario, on which a policy can be compared with the best there is."""

import ctypes
from dataclasses import dataclass

from . import library
from .library import InstanceHandle, Object, call, fill, one_of, struct, whole
from .planner import planner_options

FORMATS = {"pomdpx": 1, "pomdp": 2}


@dataclass(frozen=True)
class Evaluation:
    """What a policy costs on an instance, run once with the target at each of the poses."""

    expected_cost: float  # exact, discounted
    worst_cost: float     # of the pose that costs most
    inserted: float       # share of the poses; below 1 the costs are those until the policy gave up
    lower_bound: float    # admissible value at the start, undiscounted
    value: float          # inadmissible value at the start, undiscounted
    plans: int            # one for each belief met
    expansions: int


class Instance(Object):
    """A few poses of the target, configurations of the robot and motions. Constant: threads may share one."""

    _destroy = "tactus_instance_destroy"

    def __init__(self, scenario, *, poses=None, configurations=None, motions=None, discount=None, seed=None):
        """Draws ``poses`` from the prior and chooses up to ``motions`` sweeps and pokes, beside an insertion attempt at each pose
        and small moves, so that there are at most so many ``configurations``. Raises `InvalidArgument`, `TaskImpossible`."""
        options = struct(library.InstanceOptions, "tactus_instance_options_init")
        fill(options, poses=poses, configurations=configurations, motions=motions, discount=discount, seed=seed)
        super().__init__(self._made_by("tactus_instance_create", InstanceHandle, scenario.handle, ctypes.byref(options)))
        self._scenario = scenario

    @property
    def size(self):
        """How many there are: {"poses", "configurations", "motions"}."""
        counts = [ctypes.c_size_t() for _ in range(3)]
        call("tactus_instance_size", self.handle, *map(ctypes.byref, counts))
        return dict(zip(("poses", "configurations", "motions"), (count.value for count in counts)))

    def export(self, format="pomdpx"):
        """The text that public solvers read; ``format``: "pomdpx" (SARSOP, DESPOT) or "pomdp" (pomdp-solve, SARSOP)."""
        number, count = one_of(FORMATS, format, "format"), ctypes.c_size_t()
        call("tactus_instance_export", self.handle, number, None, 0, ctypes.byref(count))
        text = ctypes.create_string_buffer(count.value)
        call("tactus_instance_export", self.handle, number, text, count.value, ctypes.byref(count))
        return text.value.decode()

    def evaluate(self, **planner):
        """Runs a solver's policy, planning anew at every belief; the options are those of `Planner`."""
        options = planner_options(self._scenario, **planner)
        e = struct(library.EvaluationStruct, "tactus_evaluation_init")
        call("tactus_instance_evaluate", self.handle, ctypes.byref(options), ctypes.byref(e))
        return Evaluation(e.expected_cost, e.worst_cost, e.inserted, e.lower_bound, e.value, e.plans, e.expansions)

    def optimum(self, most_beliefs=200_000):
        """The least expected cost that any policy can have, discounted; NaN if it takes more than so many beliefs."""
        optimum, beliefs = ctypes.c_double(), ctypes.c_uint64()
        call("tactus_instance_optimum", self.handle, whole(most_beliefs, "most_beliefs"), ctypes.byref(optimum), ctypes.byref(beliefs))
        return optimum.value

    def bounds(self, most_beliefs=200_000):
        """Two lower bounds of the optimum, {"informed", "pairs"}: the expected cost if the pose were known, and the mean of the
        optima of pairs of poses, which have to be told apart (V* is concave); NaN if it takes more than so many beliefs."""
        informed, pairs = ctypes.c_double(), ctypes.c_double()
        call("tactus_instance_bounds", self.handle, whole(most_beliefs, "most_beliefs"), ctypes.byref(informed), ctypes.byref(pairs))
        return {"informed": informed.value, "pairs": pairs.value}

# SPDX-License-Identifier: BSD-3-Clause
"""Given a belief, the next action, within a budget."""

import ctypes
import math
from dataclasses import dataclass

import numpy as np

from . import errors, library
from .action import Action
from .library import (ActionHandle, Object, PlannerHandle, c_string, call, fill, interruptible, lib, rows, status_of, struct, value,
                      whole)

SOLVERS = ("rtdp-bel", "rtdp-inad", "rtdp-ad", "brtdp-bel", "tbl", "frontier", "rate")

REASONS = {
    errors.OK: None,
    errors.GOAL_REACHED: "goal reached",
    errors.NO_INFORMATIVE_ACTION: "no informative action",
    errors.CANCELLED: "cancelled",
}


@dataclass(frozen=True)
class Statistics:
    """What the last query took, and (total) all of them."""

    from_policy: bool     # the action was computed by an earlier query
    expansions: int       # 0 if it did not plan
    seconds: float        # 0 if it did not plan
    lower_bound: float    # admissible value, in units of cost, of the belief for which the last action was handed out; 0 before
    value: float          # inadmissible value of the same
    total_calls: int      # queries that planned
    total_expansions: int
    total_seconds: float


@dataclass(frozen=True)
class Outcome:
    """What may come of a motion."""

    probability: float
    cost: float        # of the motion then
    contact: bool
    goal: bool         # it reaches the goal; on voxels the hand-over to poses
    tool: np.ndarray   # where the tool link then stands (3), base frame, m


@dataclass(frozen=True)
class Alternative:
    """A motion that was weighed. Costs in units of cost; positions of the tool link (3), base frame, m."""

    kind: str                   # "move", "turn", "sweep", "poke" or "insertion"
    verdict: str                # "chosen", "passed over", "unreachable" or "set aside"
    lower_bound: float          # admissible value of the motion and all that follows
    value: float                # inadmissible value of the same; brtdp-bel on poses: upper bound
    motion_cost: float          # expected, of this motion alone
    information: float          # expected bits
    contact_probability: float
    goal_probability: float     # of outcomes that are the goal
    start: np.ndarray           # where the motion proper sets out from
    end: np.ndarray             # where it ends if nothing is touched
    outcomes: list              # of `Outcome`, in the order along its path; their probabilities sum to one


def planner_options(scenario, *, solver=None, seconds=None, expansions=None, epsilon=None, horizon=None, seed=None):
    """The scenario's options with what is given over them; see `Planner`."""
    options = struct(library.PlannerOptions, "tactus_planner_options_init")
    call("tactus_scenario_planner_options", scenario.handle, ctypes.byref(options))
    if solver is not None:
        options.solver = value("tactus_solver_from_name", ctypes.c_int32, c_string(solver.encode(), "solver"))
    if seconds is not None or expansions is not None:
        fill(options, budget_seconds=math.inf if seconds is None else seconds,
             budget_expansions=whole(expansions or 0, "expansions"))
    fill(options, epsilon=epsilon, horizon=horizon, seed=seed)
    return options


class Planner(Object):
    """Remembers the policy it computed, and follows it while the observations are the predicted ones. One thread at a time."""

    _destroy = "tactus_planner_destroy"

    def __init__(self, scenario, *, solver=None, seconds=None, expansions=None, epsilon=None, horizon=None, seed=None):
        """What is not given is as the scenario says.

        A query ends when the budget in ``seconds`` or the one in ``expansions`` is spent; with one of them given, the other is without
        limit. Expansions alone, and the same ``seed``, give the same actions on every machine. With ``brtdp-bel`` it takes half a second to
        make the motions for the first query, and with a budget in seconds one to two, as that query is rehearsed. Raises `InvalidArgument`."""
        options = planner_options(scenario, solver=solver, seconds=seconds, expansions=expansions, epsilon=epsilon,
                                  horizon=horizon, seed=seed)
        super().__init__(self._made_by("tactus_planner_create", PlannerHandle, scenario.handle, ctypes.byref(options)))
        self._dof = scenario.dof
        self.reason = None

    def query(self, belief):
        """The next action; None when there is none, and then ``reason`` says why: "goal reached", "no informative action" or "cancelled".

        Ctrl-C cancels it."""
        handle = ctypes.POINTER(ActionHandle)()
        with Action._given_back_unless_used(handle):
            status = interruptible(lambda: status_of("tactus_planner_query_action", self.handle, belief.handle,
                                                     ctypes.byref(handle)), self.cancel)
        self.reason = REASONS[status]
        return Action(handle, self._dof) if handle else None

    def cancel(self):
        """The query that another thread has running soon returns None, with "cancelled" for a ``reason``, unless it has its answer."""
        call("tactus_planner_cancel", self.handle)

    @property
    def statistics(self):
        s = struct(library.StatisticsStruct, "tactus_statistics_init")
        call("tactus_planner_statistics", self.handle, ctypes.byref(s))
        return Statistics(s.from_policy != 0, s.expansions, s.seconds, s.lower_bound, s.value, s.total_calls,
                          s.total_expansions, s.total_seconds)

    def alternatives(self):
        """What was weighed for the last action, in the order in which the solver would have taken it; empty if there was none.

        A list of `Alternative`, the chosen one among them. Asking changes no later answer."""
        return [self._alternative(i) for i in range(value("tactus_planner_alternative_count", ctypes.c_size_t, self.handle))]

    def _alternative(self, index):
        a = struct(library.AlternativeStruct, "tactus_alternative_init")
        call("tactus_planner_alternative", self.handle, index, ctypes.byref(a))
        outcomes = rows("tactus_planner_alternative_outcomes", self.handle, index, width=7)
        return Alternative(lib.tactus_action_kind_name(a.kind).decode(), lib.tactus_verdict_name(a.verdict).decode(),
                           a.lower_bound, a.value, a.motion_cost, a.information, a.contact_probability, a.goal_probability,
                           np.array(a.start), np.array(a.end),
                           [Outcome(row[0], row[1], bool(row[2]), bool(row[3]), row[4:]) for row in outcomes])

# SPDX-License-Identifier: BSD-3-Clause
"""Plan by touch: what a robot should touch next until the task is done, from joint positions and one bit, contact or not.

The loop::

    with tactus.Scenario.load("shelf.yaml") as scenario:
        belief, planner = tactus.Belief(scenario), tactus.Planner(scenario)
        while action := planner.query(belief):
            observation = robot.execute(action)          # guarded: it stops at the first contact
            belief.step(action, observation)             # after a contact the robot goes back to action.retreat(observation)

Units are SI and radians. Joint vectors are arrays (dof) in the order of ``scenario.joint_names``. Poses are arrays (7),
x y z qx qy qz qw, of the target in the robot's base frame. The library is found by ``TACTUS_LIBRARY``, beside this
package, in the build folder of a checkout, or where the system keeps its libraries.
"""

from .action import Action, Observation
from .belief import Belief, Event, Mode, Summary
from .errors import BadInput, Busy, InvalidArgument, StopOffPath, TactusError, TaskImpossible, WrongScenario
from .instance import Evaluation, Instance
from .library import set_log, version
from .planner import SOLVERS, Alternative, Outcome, Planner, Statistics
from .scenario import Body, Scenario, check, pose_from_rpy
from .world import World

__version__ = version()

__all__ = [
    "Action", "Alternative", "BadInput", "Belief", "Body", "Busy", "Evaluation", "Event", "Instance", "InvalidArgument", "Mode", "Observation", "Outcome",
    "Planner", "SOLVERS", "Scenario", "Statistics", "StopOffPath", "Summary", "TactusError", "TaskImpossible", "World", "WrongScenario", "check",
    "pose_from_rpy", "set_log", "version",
]

# SPDX-License-Identifier: BSD-3-Clause
"""Status codes of the library, and the exceptions they become."""

OK = 0
GOAL_REACHED = 1
NO_INFORMATIVE_ACTION = 2
CANCELLED = 3
BUFFER_TOO_SMALL = 101


class TactusError(Exception):
    """What the library refused to do and why. ``status`` is the code, ``name`` its name ("TACTUS_BUSY")."""

    def __init__(self, status, name, text):
        super().__init__(f"{name}: {text}")
        self.status = status
        self.name = name


class InvalidArgument(TactusError, ValueError):
    """A NaN, a wrong size, a number out of range; the text names the argument."""


class Busy(TactusError):
    """Another thread is using the object."""


class StopOffPath(TactusError, ValueError):
    """The robot is said to have stopped where the action does not pass."""


class WrongScenario(TactusError, ValueError):
    """The objects come from different scenarios."""


class BadInput(TactusError):
    """A file or saved state that is missing, unreadable or wrong; the text says where and what was expected."""


class TaskImpossible(TactusError):
    """The task as described can't be done: the start is in collision, the prior out of reach."""


EXCEPTIONS = {
    100: InvalidArgument,
    101: InvalidArgument,
    103: Busy,
    104: StopOffPath,
    105: WrongScenario,
    200: BadInput,
    201: BadInput,
    202: BadInput,
    203: BadInput,
    204: BadInput,
    205: BadInput,
    300: TaskImpossible,
    301: TaskImpossible,
    302: TaskImpossible,
    900: MemoryError,
}


def invalid(text):
    """The exception for an argument that the library was not even asked about."""
    return exception_for(100, "TACTUS_INVALID_ARGUMENT", text)


def exception_for(status, name, text):
    """The exception for a status of 100 or more."""
    kind = EXCEPTIONS.get(status, TactusError)
    return kind(status, name, text) if issubclass(kind, TactusError) else kind(text)

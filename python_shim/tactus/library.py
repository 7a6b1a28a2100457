# SPDX-License-Identifier: BSD-3-Clause
"""The shared library: where it is, its structs, and the type of every function in one table."""

import _thread
import contextlib
import ctypes
import ctypes.util
import operator
import os
import pathlib
from ctypes import POINTER, c_char_p, c_double, c_int32, c_int64, c_size_t, c_uint8, c_uint32, c_uint64, c_void_p

import numpy as np

from . import errors


class ScenarioHandle(ctypes.Structure):
    """An opaque handle; so are the five below."""


class BeliefHandle(ctypes.Structure):
    pass


class PlannerHandle(ctypes.Structure):
    pass


class ActionHandle(ctypes.Structure):
    pass


class WorldHandle(ctypes.Structure):
    pass


class InstanceHandle(ctypes.Structure):
    pass


class CostsStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("metre", c_double), ("radian", c_double),
                ("action", c_double)]


class LimitsStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("actions", c_int32), ("travel", c_double), ("seconds", c_double)]


class ObservationStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("contact", c_int32), ("joint_count", c_uint64),
                ("joints", POINTER(c_double))]


class ActionProperties(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("id", c_uint64), ("waypoints", c_uint64),
                ("length", c_double), ("duration", c_double), ("full_cost", c_double), ("expected_cost", c_double),
                ("contact_probability", c_double)]


class BeliefOptions(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32)]


class SummaryStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("phase", c_int32), ("health", c_int32), ("doubted", c_uint32),
                ("observations", c_uint64), ("contacts", c_uint64), ("possibly_occupied", c_uint64),
                ("volume", c_double), ("cells", c_uint64), ("bits", c_double), ("mean", c_double * 6),
                ("extent", c_double * 6), ("covariance", c_double * 36)]


class PlannerOptions(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("solver", c_int32), ("budget_seconds", c_double),
                ("budget_expansions", c_uint64), ("epsilon", c_double), ("horizon", c_int64), ("seed", c_uint64)]


class StatisticsStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("from_policy", c_int32), ("expansions", c_uint64), ("seconds", c_double),
                ("lower_bound", c_double), ("value", c_double), ("total_calls", c_uint64),
                ("total_expansions", c_uint64), ("total_seconds", c_double)]


class AlternativeStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("kind", c_int32), ("verdict", c_int32), ("outcomes", c_uint32),
                ("lower_bound", c_double), ("value", c_double), ("motion_cost", c_double), ("information", c_double),
                ("contact_probability", c_double), ("goal_probability", c_double), ("start", c_double * 3),
                ("end", c_double * 3)]


class WorldOptions(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("fineness", c_int32), ("seed", c_uint64), ("stopping_distance", c_double),
                ("encoder_error", c_double), ("missed_contacts", c_double), ("false_contacts", c_double)]


class InstanceOptions(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("poses", c_uint32), ("configurations", c_uint32), ("motions", c_uint32),
                ("discount", c_double), ("seed", c_uint64)]


class EvaluationStruct(ctypes.Structure):
    _fields_ = [("struct_size", c_uint32), ("reserved", c_uint32), ("expected_cost", c_double), ("worst_cost", c_double),
                ("inserted", c_double), ("lower_bound", c_double), ("value", c_double), ("plans", c_uint64),
                ("expansions", c_uint64)]


LOG_CALLBACK = ctypes.CFUNCTYPE(None, c_int32, c_char_p, c_void_p)

_scenario, _belief, _planner = POINTER(ScenarioHandle), POINTER(BeliefHandle), POINTER(PlannerHandle)
_action, _world, _instance = POINTER(ActionHandle), POINTER(WorldHandle), POINTER(InstanceHandle)
_doubles, _bytes, _size, _flag = POINTER(c_double), POINTER(c_uint8), POINTER(c_size_t), POINTER(c_int32)
_text = POINTER(c_char_p)

# Functions that return a status: name -> types of the arguments.
CHECKED = {
    "tactus_set_log_callback": [LOG_CALLBACK, c_void_p],
    "tactus_scenario_load": [c_char_p, POINTER(_scenario)],
    "tactus_scenario_parse": [c_char_p, c_char_p, POINTER(_scenario)],
    "tactus_scenario_check": [c_char_p, c_void_p, c_size_t, _size],
    "tactus_scenario_name": [_scenario, _text],
    "tactus_scenario_dof": [_scenario, _size],
    "tactus_scenario_joint_name": [_scenario, c_size_t, _text],
    "tactus_scenario_joint_limits": [_scenario, c_size_t, _doubles, _doubles, _doubles],
    "tactus_scenario_start": [_scenario, _doubles, c_size_t, _size],
    "tactus_costs_init": [POINTER(CostsStruct), c_size_t],
    "tactus_limits_init": [POINTER(LimitsStruct), c_size_t],
    "tactus_scenario_costs": [_scenario, POINTER(CostsStruct)],
    "tactus_scenario_limits": [_scenario, POINTER(LimitsStruct)],
    "tactus_scenario_sample_pose": [_scenario, c_uint64, _doubles],
    "tactus_scenario_save_tables": [_scenario, _bytes, c_size_t, _size],
    "tactus_scenario_restore_tables": [_scenario, _bytes, c_size_t],
    "tactus_pose_from_rpy": [_doubles, _doubles],
    "tactus_scenario_body_count": [_scenario, _size],
    "tactus_scenario_body_name": [_scenario, c_size_t, _text],
    "tactus_scenario_body_kind": [_scenario, c_size_t, _flag],
    "tactus_scenario_body_vertices": [_scenario, c_size_t, _doubles, c_size_t, _size],
    "tactus_scenario_body_triangles": [_scenario, c_size_t, POINTER(c_int32), c_size_t, _size],
    "tactus_scenario_body_poses": [_scenario, _doubles, _doubles, _doubles, c_size_t, _size],
    "tactus_scenario_belief_options": [_scenario, POINTER(BeliefOptions)],
    "tactus_scenario_planner_options": [_scenario, POINTER(PlannerOptions)],
    "tactus_observation_init": [POINTER(ObservationStruct), c_size_t],
    "tactus_action_properties_init": [POINTER(ActionProperties), c_size_t],
    "tactus_action_info": [_action, POINTER(ActionProperties)],
    "tactus_action_waypoints": [_action, _doubles, c_size_t, _size],
    "tactus_action_times": [_action, _doubles, c_size_t, _size],
    "tactus_action_retreat": [_action, POINTER(ObservationStruct), _size],
    "tactus_action_save": [_action, _bytes, c_size_t, _size],
    "tactus_action_restore": [_scenario, _bytes, c_size_t, POINTER(_action)],
    "tactus_belief_options_init": [POINTER(BeliefOptions), c_size_t],
    "tactus_belief_create": [_scenario, POINTER(BeliefOptions), _doubles, POINTER(_belief)],
    "tactus_belief_clone": [_belief, POINTER(_belief)],
    "tactus_belief_step": [_belief, _action, POINTER(ObservationStruct)],
    "tactus_belief_set_configuration": [_belief, _doubles],
    "tactus_belief_configuration": [_belief, _doubles, c_size_t, _size],
    "tactus_summary_init": [POINTER(SummaryStruct), c_size_t],
    "tactus_belief_summary": [_belief, POINTER(SummaryStruct)],
    "tactus_belief_voxels": [_belief, _doubles, c_size_t, _size],
    "tactus_belief_poses": [_belief, _doubles, c_size_t, _size],
    "tactus_belief_modes": [_belief, _doubles, c_size_t, _size],
    "tactus_belief_history": [_belief, POINTER(c_int32), c_size_t, _size],
    "tactus_belief_stops": [_belief, _doubles, c_size_t, _size],
    "tactus_belief_is_goal": [_belief, _flag],
    "tactus_belief_contains": [_belief, _doubles, _flag],
    "tactus_belief_forecast": [_belief, _action, c_int32, c_uint64, _doubles, c_size_t, _size],
    "tactus_belief_save": [_belief, _bytes, c_size_t, _size],
    "tactus_belief_restore": [_scenario, _bytes, c_size_t, POINTER(_belief)],
    "tactus_solver_from_name": [c_char_p, _flag],
    "tactus_planner_options_init": [POINTER(PlannerOptions), c_size_t],
    "tactus_planner_create": [_scenario, POINTER(PlannerOptions), POINTER(_planner)],
    "tactus_planner_query_action": [_planner, _belief, POINTER(_action)],
    "tactus_planner_cancel": [_planner],
    "tactus_statistics_init": [POINTER(StatisticsStruct), c_size_t],
    "tactus_planner_statistics": [_planner, POINTER(StatisticsStruct)],
    "tactus_alternative_init": [POINTER(AlternativeStruct), c_size_t],
    "tactus_planner_alternative_count": [_planner, _size],
    "tactus_planner_alternative": [_planner, c_size_t, POINTER(AlternativeStruct)],
    "tactus_planner_alternative_outcomes": [_planner, c_size_t, _doubles, c_size_t, _size],
    "tactus_world_options_init": [POINTER(WorldOptions), c_size_t],
    "tactus_world_create": [_scenario, _doubles, POINTER(WorldOptions), POINTER(_world)],
    "tactus_world_execute": [_world, _action, POINTER(ObservationStruct)],
    "tactus_world_inserted": [_world, _flag],
    "tactus_world_travelled": [_world, _doubles, _doubles],
    "tactus_world_true_pose": [_world, _doubles],
    "tactus_instance_options_init": [POINTER(InstanceOptions), c_size_t],
    "tactus_instance_create": [_scenario, POINTER(InstanceOptions), POINTER(_instance)],
    "tactus_instance_size": [_instance, _size, _size, _size],
    "tactus_instance_export": [_instance, c_int32, c_void_p, c_size_t, _size],
    "tactus_evaluation_init": [POINTER(EvaluationStruct), c_size_t],
    "tactus_instance_evaluate": [_instance, POINTER(PlannerOptions), POINTER(EvaluationStruct)],
    "tactus_instance_bounds": [_instance, c_uint64, _doubles, _doubles],
    "tactus_instance_optimum": [_instance, c_uint64, _doubles, POINTER(c_uint64)],
}

# The others: name -> (type of the result, types of the arguments).
PLAIN = {
    "tactus_version": (c_int32, []),
    "tactus_version_string": (c_char_p, []),
    "tactus_status_name": (c_char_p, [c_int32]),
    "tactus_last_error": (c_char_p, []),
    "tactus_action_kind_name": (c_char_p, [c_int32]),
    "tactus_solver_name": (c_char_p, [c_int32]),
    "tactus_verdict_name": (c_char_p, [c_int32]),
    "tactus_scenario_destroy": (None, [_scenario]),
    "tactus_belief_destroy": (None, [_belief]),
    "tactus_planner_destroy": (None, [_planner]),
    "tactus_action_destroy": (None, [_action]),
    "tactus_world_destroy": (None, [_world]),
    "tactus_instance_destroy": (None, [_instance]),
}


# --- loading

def _candidates():
    """Where the library may be, the likeliest first."""
    if path := os.environ.get("TACTUS_LIBRARY"):
        return [path]
    package = pathlib.Path(__file__).resolve().parent
    paths = [package / "libtactus.so", package.parents[1] / "build" / "release" / "lib" / "libtactus.so"]
    return [str(path) for path in paths if path.exists()] + [ctypes.util.find_library("tactus") or "libtactus.so.0"]


def _load():
    """The library with every function typed. Raises ImportError with all that was tried."""
    tried = []
    for path in _candidates():
        try:
            library = ctypes.CDLL(path)
            break
        except OSError as error:
            tried.append(f"  {path}: {error}")
    else:
        raise ImportError("libtactus.so was not found; set TACTUS_LIBRARY to its path. Tried:\n" + "\n".join(tried))
    for name, argtypes in CHECKED.items():
        function = getattr(library, name)
        function.restype, function.argtypes = c_int32, argtypes
    for name, (restype, argtypes) in PLAIN.items():
        function = getattr(library, name)
        function.restype, function.argtypes = restype, argtypes
    return library


lib = _load()


# --- calling

def text(given):
    """What the library says; a file's name or its contents in it need not be UTF-8."""
    return given.decode(errors="replace")


def status_of(name, *arguments):
    """Calls ``name`` and returns its status, below 100. Raises for an error."""
    status = getattr(lib, name)(*arguments)
    if status >= 100:
        raise errors.exception_for(status, text(lib.tactus_status_name(status)), text(lib.tactus_last_error()))
    return status


def call(name, *arguments):
    """The same where the status says nothing more."""
    status_of(name, *arguments)


def value(name, kind, *arguments):
    """The one value that ``name`` writes to its last argument."""
    out = kind()
    call(name, *arguments, ctypes.byref(out))
    return out.value


def struct(kind, name):
    """A struct made ready by its ``_init`` function ``name``."""
    made = kind()
    call(name, ctypes.byref(made), ctypes.sizeof(made))
    return made


def fill(made, **wishes):
    """Sets the fields of a struct for which there is a wish. Raises for a whole number that a field has no room for."""
    kinds = dict(made._fields_)
    for name, wish in wishes.items():
        if wish is not None:
            setattr(made, name, wish if kinds[name] is c_double else whole(wish, name, kinds[name]))


def whole(number, argument, kind=c_uint64):
    """``number``, an int or one of numpy's, if ``kind`` has room for it."""
    number = operator.index(number)
    if kind(number).value != number:
        signed, bits = kind(-1).value < 0, 8 * ctypes.sizeof(kind)
        low, high = (-1 << bits - 1, (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
        raise errors.invalid(f"{argument}: found {number}, expected a whole number from {low} to {high}")
    return number


def c_string(encoded, argument):
    """``encoded``, if the library will see all of it."""
    if b"\0" in encoded:
        raise errors.invalid(f"{argument}: found a zero at byte {encoded.index(0)}, expected text without one")
    return encoded


def one_of(choices, word, argument):
    """What ``choices`` has for ``word``."""
    if word not in choices:
        raise errors.invalid(f"{argument}: found {word!r}, expected one of {', '.join(map(repr, choices))}")
    return choices[word]


def rows(name, *arguments, width=None, dtype=np.float64):
    """The array that ``name`` gives out: (count x width), or (count) without a width."""
    count = c_size_t()
    call(name, *arguments, None, 0, ctypes.byref(count))
    array = np.empty(count.value if width is None else (count.value, width), dtype)
    call(name, *arguments, pointer(array), count.value, ctypes.byref(count))
    return array


def pointer(array):
    """The address of a contiguous array's values."""
    return array.ctypes.data_as(POINTER(np.ctypeslib.as_ctypes_type(array.dtype)))


def vector(values, size, argument):
    """``values`` as a contiguous array of ``size`` doubles."""
    array = np.array(values, np.float64).ravel()
    if array.size != size:
        raise errors.invalid(f"{argument}: found {array.size} numbers, expected {size}")
    return array


def interruptible(work, stop):
    """``work()``, on a thread of its own. Meanwhile signals are heard: what their handlers raise, as Ctrl-C does, calls ``stop()`` until
    ``work`` has come to its end, and is raised then. Plain locks, as Python's other means of waiting do not bear Ctrl-C twice."""
    begun, under_way, came_of_it = _thread.allocate_lock(), _thread.allocate_lock(), []
    under_way.acquire()

    def run():
        if not begun.acquire(blocking=False):
            return  # interrupted before
        try:
            came_of_it.append((work(), None))
        except BaseException as error:
            came_of_it.append((None, error))
        under_way.release()

    try:
        _thread.start_new_thread(run, ())
        while not under_way.acquire(timeout=0.05):
            pass  # a signal that comes just before one waits, or to another thread, does not end the waiting
    except BaseException:
        has_begun = not begun.acquire(blocking=False)
        while has_begun and not came_of_it:
            try:
                stop()  # unheard if `work` is yet to begin what it stops
                under_way.acquire(timeout=0.01)
            except BaseException:  # Ctrl-C again
                pass
        raise
    result, error = came_of_it.pop()
    if error is not None:
        raise error
    return result


class Object:
    """Owns a handle. ``close`` (or the end of a ``with`` block) gives it back; an object used after that raises."""

    _destroy = None  # the function that destroys the handle

    def __init__(self, handle):
        self._handle = handle

    @classmethod
    def _made_by(cls, name, handle_type, *arguments):
        handle = POINTER(handle_type)()
        with cls._given_back_unless_used(handle):
            call(name, *arguments, ctypes.byref(handle))
        return handle

    @classmethod
    @contextlib.contextmanager
    def _given_back_unless_used(cls, handle):
        """Ctrl-C may come when the library has made the object, and nobody has it yet."""
        try:
            yield
        except BaseException:
            if handle:
                getattr(lib, cls._destroy)(handle)
            raise

    @property
    def handle(self):
        if self._handle is None:
            raise ValueError(f"this {type(self).__name__} is closed")
        return self._handle

    def close(self):
        handle, self._handle = getattr(self, "_handle", None), None
        if handle is not None:
            getattr(lib, self._destroy)(handle)

    def __reduce__(self):
        raise TypeError(f"{type(self).__name__}: it owns what the library made, and can't be copied or pickled")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if lib is not None:  # the interpreter may be going down
            self.close()


# --- the library itself

_log_callbacks = []  # all that were ever set: a line on its way may still reach an earlier one


def set_log(function):
    """Sends the library's log to ``function(level, message)``; level 0 is debug, 3 an error. None: nowhere."""
    callback = LOG_CALLBACK() if function is None else LOG_CALLBACK(
        lambda level, message, _: function(level, text(message)))
    _log_callbacks.append(callback)
    call("tactus_set_log_callback", callback, None)


def version():
    """The version of the library that is loaded, "0.1.0"."""
    return lib.tactus_version_string().decode()

# SPDX-License-Identifier: BSD-3-Clause
"""What the Python package does beside handing things on: copies, texts that are not UTF-8, numbers and words out of range, Ctrl-C."""

import contextlib
import copy
import gc
import os
import pathlib
import pickle
import signal
import threading
import time

import numpy as np
import pytest

from built import SHELF, tactus
from tactus import library

REPLACEMENT = "\N{REPLACEMENT CHARACTER}"
UNLIMITED = {"expansions": 2**64 - 1}
LONG_WORD = "x" + 60 * "ä"  # every character but the first ends at an odd byte: wherever an even number is cut, one is halved


@pytest.fixture(scope="module")
def action(scenario):
    return planner_of(scenario).query(tactus.Belief(scenario))


@pytest.fixture(scope="module")
def instance(scenario):
    with tactus.Instance(scenario, poses=2, configurations=8, motions=2) as made:
        yield made


def planner_of(scenario, **options):
    return tactus.Planner(scenario, **{"solver": "rate", "expansions": 1, **options})


# --- copies

@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, tactus.Belief.clone])
def test_a_copy_of_a_belief_is_independent_and_acts_alike(scenario, action, copied):
    belief = tactus.Belief(scenario)
    twin = copied(belief)
    seen = tactus.Observation(False, action.waypoints[-1])
    twin.step(action, seen)
    assert (belief.summary.observations, twin.summary.observations) == (0, 1)
    belief.step(action, seen)
    assert twin.save() == belief.save()
    belief.close()
    assert planner_of(scenario).query(twin).id and twin.configuration.shape == (scenario.dof,)


def test_a_deep_copy_keeps_what_is_one_belief_one(scenario):
    belief = tactus.Belief(scenario)
    first, second = copy.deepcopy([belief, belief])
    assert first is second and first is not belief


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, pickle.dumps])
def test_what_has_one_owner_cant_be_copied(scenario, action, instance, copied):
    belief, world = tactus.Belief(scenario), tactus.World(scenario, scenario.sample_pose(1))
    planner = planner_of(scenario)
    for owned in (scenario, planner, world, action, instance):
        with pytest.raises(TypeError, match=f"{type(owned).__name__}.*cop"):
            copied(owned)
    gc.collect()
    found = planner.query(belief)
    belief.step(found, world.execute(found))
    assert found.id == action.id and instance.size["poses"] == 2 and belief.summary.observations == 1


def test_a_belief_cant_be_pickled(scenario):
    with pytest.raises(TypeError, match="Belief"):
        pickle.dumps(tactus.Belief(scenario))


# --- texts

def test_a_file_name_need_not_be_utf8(tmp_path):
    with pytest.raises(tactus.BadInput, match=f"{REPLACEMENT}.yaml"):
        tactus.Scenario.load(b"/tmp/\xff.yaml")
    assert f"{REPLACEMENT}.yaml" in tactus.check(b"/tmp/\xff.yaml")[0]
    there = os.fsencode(tmp_path) + b"/caf\xe9.yaml"
    pathlib.Path(os.fsdecode(there)).write_text("robot: 3\n")
    with pytest.raises(tactus.BadInput, match=f"caf{REPLACEMENT}.yaml:1: robot"):
        tactus.Scenario.load(there)


def test_a_file_need_not_be_utf8(tmp_path):
    (tmp_path / "latin.yaml").write_bytes(b"planner: {solver: caf\xe9}\n")
    with pytest.raises(tactus.BadInput, match="planner.solver.*caf"):
        tactus.Scenario.load(tmp_path / "latin.yaml")
    assert any("planner.solver" in line for line in tactus.check(tmp_path / "latin.yaml"))


def test_a_long_word_is_reported(scenario):
    with pytest.raises(tactus.InvalidArgument, match="xä"):
        planner_of(scenario, solver=LONG_WORD)
    with pytest.raises(tactus.BadInput, match="planner.solver.*xä"):
        tactus.Scenario.parse(f"planner: {{solver: {LONG_WORD}}}\n")


def test_a_text_with_a_zero_in_it_is_refused_not_cut(scenario):
    with pytest.raises(tactus.InvalidArgument, match="yaml"):
        tactus.Scenario.parse("robot: 3\n\0prior: 4\n")
    with pytest.raises(tactus.InvalidArgument, match="base_dir"):
        tactus.Scenario.parse("robot: 3\n", "/tmp\0/x")
    for takes_a_path in (tactus.Scenario.load, tactus.check):
        with pytest.raises(tactus.InvalidArgument, match="path"):
            takes_a_path(f"{SHELF}\0.txt")
    with pytest.raises(tactus.InvalidArgument, match="solver"):
        planner_of(scenario, solver="rate\0")


# --- whole numbers

@pytest.mark.parametrize("number", [int, np.int64])
@pytest.mark.parametrize("argument", ["expansions", "seed"])
def test_a_planner_refuses_negative_numbers(scenario, argument, number):
    with pytest.raises(tactus.InvalidArgument, match=f"^TACTUS_INVALID_ARGUMENT: {argument}: found -1, expected .* from 0 to"):
        planner_of(scenario, **{argument: number(-1)})


@pytest.mark.parametrize("argument, number", [
    ("expansions", 2**64), ("expansions", 2**64 + 3), ("seed", 2**64), ("horizon", 2**63), ("horizon", 2**64 + 1),
    ("horizon", -2**63 - 1), ("horizon", 2**200)])
def test_a_planner_refuses_numbers_that_are_too_large(scenario, argument, number):
    with pytest.raises(tactus.InvalidArgument, match=f"{argument}: found {number}"):
        planner_of(scenario, **{argument: number})


@pytest.mark.parametrize("argument, number", [
    ("fineness", 2**31), ("fineness", 2**32 + 1), ("fineness", np.uint64(2**32 + 1)), ("seed", -1), ("seed", 2**64)])
def test_a_world_refuses_numbers_that_dont_fit(scenario, argument, number):
    with pytest.raises(tactus.InvalidArgument, match=f"{argument}: found {number}"):
        tactus.World(scenario, scenario.sample_pose(1), **{argument: number})


def test_so_do_the_others(scenario, action, instance):
    belief = tactus.Belief(scenario)
    for number in (-1, 2**64):
        for argument, ask in (("seed", scenario.sample_pose), ("most_beliefs", instance.optimum), ("most_beliefs", instance.bounds),
                              ("seed", lambda seed: belief.forecast(action, seed=seed)),
                              ("poses", lambda poses: tactus.Instance(scenario, poses=poses))):
            with pytest.raises(tactus.InvalidArgument, match=f"{argument}: found {number}"):
                ask(number)


def test_the_largest_numbers_fit_and_numpys_do_as_well(scenario):
    most = 2**64 - 1
    np.testing.assert_array_equal(scenario.sample_pose(np.uint64(most)), scenario.sample_pose(most))
    assert planner_of(scenario, seed=most, expansions=np.int64(1), horizon=2**31 - 1).query(tactus.Belief(scenario)).id
    assert not tactus.World(scenario, scenario.sample_pose(np.int32(1)), seed=np.uint64(most), fineness=np.int8(2)).inserted


def test_a_fraction_is_no_whole_number(scenario):
    for options in ({"expansions": 1.5}, {"horizon": 2.0}, {"seed": "1"}):
        with pytest.raises(TypeError):
            planner_of(scenario, **options)
    with pytest.raises(TypeError):
        scenario.sample_pose(1.0)


# --- words

def test_unknown_words_are_named_beside_the_choices(scenario, action, instance):
    belief = tactus.Belief(scenario)
    for argument, word, choices, ask in (
            ("kind", "particle", ["hierarchical", "particles"], lambda word: tactus.Belief(scenario, kind=word)),
            ("likelihood", "papr", ["paper", "calibrated"], lambda word: belief.forecast(action, likelihood=word)),
            ("format", "x", ["pomdpx", "pomdp"], lambda word: instance.export(format=word)),
            ("solver|name", "guess", tactus.SOLVERS, lambda word: planner_of(scenario, solver=word))):
        with pytest.raises(tactus.InvalidArgument, match=f"({argument}): found '{word}', expected") as caught:
            ask(word)
        assert all(choice in str(caught.value) for choice in choices)


# --- Ctrl-C

@contextlib.contextmanager
def ctrl_c(*after):
    """Comes after so many seconds, and again so many later, as it comes from a keyboard."""
    waits = list(after)

    def heard(number, frame):
        if waits:
            signal.setitimer(signal.ITIMER_REAL, waits.pop(0))
        signal.default_int_handler(number, frame)

    before = signal.signal(signal.SIGALRM, heard)
    try:
        signal.setitimer(signal.ITIMER_REAL, waits.pop(0))
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def interrupted(planner, belief, *after):
    """How long a query without limit takes when Ctrl-C comes."""
    rescue = threading.Timer(30.0, planner.cancel)
    rescue.start()
    started = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt), ctrl_c(*after):
            planner.query(belief)
            pytest.fail(f"the query ended by itself: {planner.reason}")
    finally:
        rescue.cancel()
        rescue.join()
    return time.monotonic() - started


@pytest.mark.parametrize("limits", [UNLIMITED, {"expansions": None, "seconds": 1e9}])
def test_ctrl_c_cancels_a_query_and_the_planner_can_be_asked_again(scenario, limits):
    planner, belief = planner_of(scenario, solver="rtdp-bel", **limits), tactus.Belief(scenario)
    for _ in range(2):
        assert interrupted(planner, belief, 0.5) < 2.5
    assert belief.summary.observations == 0
    canceller = threading.Timer(0.5, planner.cancel)
    canceller.start()
    assert planner.query(belief) is None and planner.reason == "cancelled"
    canceller.join()


def test_ctrl_c_at_once_is_heard_too(scenario):
    planner, belief = planner_of(scenario, solver="rtdp-bel", **UNLIMITED), tactus.Belief(scenario)
    for after in np.linspace(1e-5, 3e-3, 20):
        assert interrupted(planner, belief, after) < 2.0


def test_after_ctrl_c_a_planner_answers(scenario):
    planner, belief = planner_of(scenario, solver="rate", expansions=1), tactus.Belief(scenario)
    with contextlib.suppress(KeyboardInterrupt), ctrl_c(0.002):
        planner.query(belief)
    found = planner.query(belief)
    assert found.kind in ("move", "turn", "sweep", "poke", "insertion") and planner.reason is None
    belief.step(found, tactus.Observation(False, found.waypoints[-1]))


def test_a_stop_is_asked_for_until_it_is_heard():
    stops = []

    def deaf_at_first():
        end = time.monotonic() + 10.0
        while len(stops) < 3 and time.monotonic() < end:
            time.sleep(0.001)

    with pytest.raises(KeyboardInterrupt), ctrl_c(0.1):
        library.interruptible(deaf_at_first, lambda: stops.append(None))
    assert len(stops) >= 3


def test_a_second_ctrl_c_waits_for_the_end_as_well():
    stopped, ended = threading.Event(), threading.Event()

    def slow_to_end():
        stopped.wait(10.0)
        time.sleep(0.3)
        ended.set()

    with pytest.raises(KeyboardInterrupt), ctrl_c(0.1, 0.1, 0.1):
        library.interruptible(slow_to_end, stopped.set)
    assert ended.is_set()


def test_what_work_returns_or_raises_comes_through():
    assert library.interruptible(lambda: 7, None) == 7
    with pytest.raises(ZeroDivisionError):
        library.interruptible(lambda: 1 // 0, None)
    with pytest.raises(KeyboardInterrupt):
        library.interruptible(lambda: signal.raise_signal(signal.SIGINT) or time.sleep(0.2), lambda: None)


def test_errors_of_a_query_are_told(scenario):
    planner, belief = planner_of(scenario, solver="rtdp-bel", **UNLIMITED), tactus.Belief(scenario)
    other = threading.Thread(target=planner.query, args=[belief])
    other.start()
    with pytest.raises(tactus.Busy):
        while other.is_alive():
            planner.statistics
    with pytest.raises(tactus.Busy, match="planner"):
        planner.query(belief)
    while other.is_alive():
        planner.cancel()
        other.join(0.01)


# --- what the last query took

def test_values_are_of_the_belief_that_the_last_action_was_for(scenario):
    planner, belief = planner_of(scenario, solver="rtdp-bel", **UNLIMITED), tactus.Belief(scenario)
    assert (planner.statistics.lower_bound, planner.statistics.value) == (0.0, 0.0)
    interrupted(planner, belief, 0.3)
    assert (planner.statistics.lower_bound, planner.statistics.value) == (0.0, 0.0)
    planner = planner_of(scenario, solver="rtdp-bel", expansions=None, seconds=1.0)
    planner.query(belief)
    after = planner.statistics
    interrupted(planner, belief, 0.2)
    assert planner.statistics.total_calls == after.total_calls + 1
    assert (planner.statistics.lower_bound, planner.statistics.value) == (after.lower_bound, after.value) and after.value > 0.0

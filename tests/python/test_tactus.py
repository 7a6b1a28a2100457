# SPDX-License-Identifier: BSD-3-Clause
"""The Python package, the examples and the command: the same loop, the same numbers."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from built import BUILD, LIBRARY, ROOT, SHELF, tactus

SEED, EXPANSIONS = 1, 2


@pytest.fixture(scope="module")
def action(scenario):
    return tactus.Planner(scenario, expansions=EXPANSIONS).query(tactus.Belief(scenario))


# --- the package

def test_every_exported_function_is_typed_and_no_other():
    from tactus import library
    exported = (ROOT / "tests" / "abi" / "symbols.txt").read_text().split()
    assert sorted([*library.CHECKED, *library.PLAIN]) == exported


def test_scenario_says_what_it_is(scenario):
    assert scenario.name == "small_shelf"
    assert scenario.dof == len(scenario.joint_names) == 6
    assert scenario.joint_limits.shape == (6, 3)
    assert scenario.start.shape == (6,)
    assert scenario.costs == {"metre": 1.0, "radian": 0.05, "action": 0.005}
    assert [body.kind for body in scenario.bodies].count("target") == 1
    poses = scenario.body_poses(scenario.start, scenario.sample_pose(3))
    np.testing.assert_allclose(poses[-1], scenario.sample_pose(3), atol=1e-12)


def test_pose_from_rpy():
    np.testing.assert_allclose(tactus.pose_from_rpy(1, 2, 3, 0, 0, np.pi), [1, 2, 3, 0, 0, 1, 0], atol=1e-12)


def test_errors_are_exceptions_that_name_the_argument(scenario, action):
    with pytest.raises(tactus.BadInput, match="nowhere.yaml"):
        tactus.Scenario.load("/nowhere.yaml")
    with pytest.raises(tactus.InvalidArgument, match="solver|name"):
        tactus.Planner(scenario, solver="guess")
    with pytest.raises(tactus.InvalidArgument, match="q: found 2"):
        tactus.Belief(scenario, [1.0, 2.0])
    belief = tactus.Belief(scenario)
    with pytest.raises(tactus.StopOffPath) as caught:
        belief.step(action, tactus.Observation(False, scenario.start + 1.0))
    assert caught.value.status == 104 and caught.value.name == "TACTUS_STOP_OFF_PATH"
    with pytest.raises(tactus.InvalidArgument, match=r"joints\[0\]"):
        belief.step(action, tactus.Observation(False, np.full(6, np.nan)))


def test_check_lists_what_is_wrong(tmp_path):
    assert tactus.check(SHELF) == []
    (tmp_path / "bad.yaml").write_text("robot: 3\nprior: 4\n")
    assert len(tactus.check(tmp_path / "bad.yaml")) >= 2


def test_closed_objects_say_so(scenario):
    belief = tactus.Belief(scenario)
    belief.close()
    belief.close()
    with pytest.raises(ValueError, match="closed"):
        belief.summary


def test_a_missing_library_is_told_with_its_path():
    result = subprocess.run([sys.executable, "-c", "import tactus"], capture_output=True, text=True,
                            env={**os.environ, "TACTUS_LIBRARY": "/nowhere.so", "PYTHONPATH": str(ROOT / "python_shim")})
    assert result.returncode != 0 and "/nowhere.so" in result.stderr


def test_save_and_restore(scenario, action):
    belief = tactus.Belief(scenario)
    belief.step(action, tactus.Observation(False, action.waypoints[-1]))
    restored = tactus.Belief.restore(scenario, belief.save())
    assert restored.save() == belief.save()
    assert tactus.Action.restore(scenario, action.save()).id == action.id
    with pytest.raises(tactus.BadInput):
        tactus.Belief.restore(scenario, b"")


def test_tables_are_kept_and_change_no_answer():
    shelf = ROOT / "examples" / "scenarios" / "shelf_3d.yaml"  # more cells than a list takes
    first, second = (tactus.Scenario.load(shelf) for _ in range(2))
    beliefs = [tactus.Belief(scenario, kind="particles") for scenario in (first, second)]
    action = tactus.Planner(first, solver="rate", expansions=2).query(beliefs[0])
    seen = tactus.Observation(False, action.waypoints[-1])
    beliefs[0].step(action, seen)
    data = first.save_tables()
    assert len(data) > 10000
    second.restore_tables(data)
    beliefs[1].step(tactus.Action.restore(second, action.save()), seen)
    assert second.save_tables() == data and beliefs[1].save() == beliefs[0].save()
    with pytest.raises(tactus.BadInput, match="contact tables"):
        second.restore_tables(data[:-1])


def test_arrays_have_their_shapes(scenario, action):
    assert action.waypoints.shape == (len(action.times), 6)
    assert action.kind in ("move", "turn", "sweep", "poke", "insertion")
    belief = tactus.Belief(scenario)
    summary = belief.summary
    assert belief.voxels.shape == (summary.possibly_occupied, 3) and belief.poses.shape == (0, 7)
    assert summary.covariance.shape == (6, 6) and summary.phase == "voxels"


def test_an_instance_brackets_a_policy(scenario):
    with tactus.Instance(scenario, poses=6, configurations=20, motions=3) as instance:
        assert instance.size["poses"] == 6
        found = instance.evaluate(solver="rate", expansions=50)
        assert found.inserted == pytest.approx(1.0)
        assert found.lower_bound * 0.9 < instance.optimum() <= found.expected_cost + 1e-9 <= found.worst_cost + 2e-9
        assert np.isnan(instance.optimum(most_beliefs=1))
        assert 0.0 < instance.bounds()["informed"] < instance.bounds()["pairs"] <= instance.optimum() + 1e-9
        assert "<Discount>0.999" in instance.export() and "discount: 0.999" in instance.export("pomdp")
    with pytest.raises(tactus.InvalidArgument, match="poses"):
        tactus.Instance(scenario, poses=0)


def test_a_belief_tells_its_history_and_its_modes(scenario, action):
    belief = tactus.Belief(scenario, kind="particles")
    belief.step(action, tactus.Observation(True, action.waypoints[1]))
    (event,) = belief.history
    assert (event.kind, event.contact, event.doubted) == (action.kind, True, True)
    np.testing.assert_array_equal(event.q, action.waypoints[1])
    assert belief.summary.doubted == 1
    assert sum(mode.mass for mode in belief.modes) == pytest.approx(1.0)


def test_a_planner_says_why(scenario):
    planner, belief = tactus.Planner(scenario, solver="rtdp-bel", expansions=EXPANSIONS), tactus.Belief(scenario)
    assert planner.alternatives() == []
    action = planner.query(belief)
    weighed = planner.alternatives()
    assert [a.value for a in weighed] == sorted(a.value for a in weighed)
    chosen, = (a for a in weighed if a.verdict == "chosen")
    assert (chosen.kind, chosen.value) == (action.kind, action.expected_cost)
    assert chosen.start.shape == chosen.end.shape == (3,)
    for a in weighed:
        assert sum(o.probability for o in a.outcomes) == pytest.approx(1.0)
        assert sum(o.probability * o.cost for o in a.outcomes) == pytest.approx(a.motion_cost)
        assert sum(o.probability for o in a.outcomes if o.goal) == pytest.approx(a.goal_probability)
        assert all(o.tool.shape == (3,) for o in a.outcomes)
    unasked = tactus.Planner(scenario, solver="rtdp-bel", expansions=EXPANSIONS)
    unasked.query(belief)
    belief.step(action, tactus.Observation(False, action.waypoints[-1]))
    assert planner.query(belief).id == unasked.query(belief).id


def test_an_imperfect_robot_is_the_same_for_the_same_seed(scenario, action):
    def seen(seed):
        world = tactus.World(scenario, scenario.sample_pose(1), seed=seed, stopping_distance=0.002, encoder_error=0.0001)
        return world.execute(action).joints

    perfect = tactus.World(scenario, scenario.sample_pose(1)).execute(action).joints
    assert np.array_equal(seen(3), seen(3)) and not np.array_equal(seen(3), seen(4))
    assert not np.array_equal(seen(3), perfect)
    np.testing.assert_allclose(seen(3), perfect, atol=0.05)
    with pytest.raises(tactus.InvalidArgument, match="missed_contacts"):
        tactus.World(scenario, scenario.sample_pose(1), missed_contacts=0.6)


# --- the loop, three times

@pytest.fixture(scope="module")
def loop_in_c():
    return run(BUILD / "bin" / "shelf_loop", SHELF, SEED, EXPANSIONS)


def run(*command):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=280)
    assert result.returncode in (0, 1), result.stderr
    return result.stdout.splitlines()


def test_examples_print_the_same(loop_in_c):
    assert loop_in_c == run(sys.executable, ROOT / "examples" / "python" / "shelf_loop.py", SHELF, SEED, EXPANSIONS)


def test_command_goes_the_same_way_and_writes_json_and_record(loop_in_c, tmp_path):
    record = tmp_path / "record.json"
    document = json.loads("\n".join(run(BUILD / "bin" / "tactus", "run", SHELF, "--seed", SEED, "--budget-expansions",
                                        EXPANSIONS, "--json", "-", "--record", record)))
    assert list(document) == ["scenario", "solver", "belief", "trials", "summary"]
    trial, = document["trials"]
    assert list(trial) == ["seed", "true_pose", "inserted", "truth_kept", "cost_m", "travel_m", "rotation_rad", "actions",
                           "contacts", "planner_calls", "planning_s", "phase1_cost_m", "position_error_m",
                           "angle_error_rad", "phase1_travel_m", "phase1_rotation_rad", "phase1_actions",
                           "phase1_planner_calls", "phase1_planning_s", "slowest_planning_s", "late_plans",
                           "stepping_s", "slowest_step_s",
                           "poses_lower_bound", "poses_value"]
    assert trial["actions"] == len(loop_in_c) - 1 and trial["inserted"] == (loop_in_c[-1] == "inserted")
    assert trial["cost_m"] == pytest.approx(
        trial["travel_m"] + 0.05 * trial["rotation_rad"] + 0.005 * trial["actions"], rel=1e-6)
    check_record(json.loads(record.read_text()), trial)
    assert record.stat().st_size < 6e6


def test_command_keeps_tables_and_goes_the_same_way_with_them(tmp_path):
    tables = tmp_path / "shelf.tables"

    def trial():
        document = json.loads("\n".join(run(BUILD / "bin" / "tactus", "run", SHELF, "--seed", SEED, "--belief", "particles",
                                            "--budget-expansions", EXPANSIONS, "--json", "-", "--tables", tables)))
        return {name: number for name, number in document["trials"][0].items() if not name.endswith("_s")}

    first = trial()
    kept = tables.read_bytes()
    assert trial() == first and tables.read_bytes() == kept
    tables.write_bytes(kept[:-1])
    spoilt = subprocess.run([BUILD / "bin" / "tactus", "run", SHELF, "--tables", tables], capture_output=True, text=True)
    assert spoilt.returncode == 2 and "--tables" in spoilt.stderr and "contact tables" in spoilt.stderr


def test_command_simulates_an_imperfect_robot():
    def trial(*options):
        return json.loads("\n".join(run(BUILD / "bin" / "tactus", "run", SHELF, "--seed", SEED, "--budget-expansions",
                                        EXPANSIONS, "--json", "-", *options)))["trials"][0]

    perfect, other = trial(), trial("--stopping-distance", "0.001", "--false-contacts", "0.5")
    assert list(other) == list(perfect)
    assert other["travel_m"] != perfect["travel_m"] and other["true_pose"] == perfect["true_pose"]


def check_record(record, trial):
    assert record["true_pose"] == trial["true_pose"]
    assert len(record["steps"]) == trial["actions"]
    assert {frame["action"] for frame in record["frames"]} == set(range(trial["actions"]))
    assert all(len(frame["poses"]) == len(record["bodies"]) for frame in record["frames"])
    assert sum(frame["contact"] for frame in record["frames"]) == trial["contacts"]
    for step in record["steps"]:
        assert len(step["belief"]["points"]) <= 3000
        check_why(step)


def check_why(step):
    told = step["why"]["alternatives"]
    assert 1 <= len(told) <= min(6, step["why"]["weighed"])
    assert [a["kind"] for a in told if a["verdict"] == "chosen"] == [step["kind"]]
    assert all(a["verdict"] in ("unreachable", "set aside") for a in told[:[a["verdict"] for a in told].index("chosen")])
    for a in told:
        assert sum(outcome[0] for outcome in a["outcomes"]) == pytest.approx(1.0, abs=1e-3)


# --- the command where something is wrong

def said_by_run(*options):
    return subprocess.run([str(word) for word in (BUILD / "bin" / "tactus", "run", *options)], capture_output=True, text=True, timeout=200)


@pytest.fixture
def near(tmp_path):
    """The target may touch the robot at its start: it does at seed 4, and not at 3 and 5."""
    text = SHELF.read_text()
    for old, new in [("../../examples", f"{ROOT}/examples"), ("[1.004, 0.05, 0.55]", "[0.68, 0.05, 0.5]"), ("{y: 0.04", "{y: 0.3"),
                     ("actions: 3", "actions: 1")]:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "near.yaml"
    path.write_text(text)
    return path


def test_command_goes_on_after_a_trial_that_could_not_begin(near, tmp_path):
    path = tmp_path / "results.json"
    words = (near, "--solver", "rate", "--budget-expansions", 1, "--seed", 3, "--trials", 3, "--json", path)
    result = said_by_run(*words)
    assert result.returncode == 1 and "seed 4: rate: TACTUS_START_IN_COLLISION" in result.stderr and "nan" not in result.stdout
    document = json.loads(path.read_text())
    ran, failed, other = document["trials"]
    assert document["summary"]["ended"] == ["limit of actions", "error", "limit of actions"]
    assert (failed["seed"], failed["inserted"], failed["cost_m"], failed["actions"], failed["planning_s"]) == (4, False, None, None, None)
    assert document["summary"]["mean_cost_m"] == pytest.approx((ran["cost_m"] + other["cost_m"]) / 2, rel=1e-6)
    assert document["summary"]["mean_actions"] == document["summary"]["mean_planner_calls"] == 1
    again = said_by_run(*words, "--resume")
    assert again.returncode == 1 and "3 of 3 trials are there" in again.stderr and "ended:" not in again.stderr
    assert json.loads(path.read_text())["trials"] == document["trials"]


def test_command_does_not_go_on_in_another_scenario_of_the_same_name(near, tmp_path):
    path = tmp_path / "results.json"
    words = (near, "--solver", "rate", "--budget-expansions", 1, "--seed", 4, "--json", path)
    assert said_by_run(*words).returncode == 1
    kept, text = path.read_bytes(), near.read_text()
    for old, new, complaint in [("{y: 0.3", "{y: 0.2", "a trial of seed 4 with the target at [0.68,"),
                                ("actions: 1", "actions: 2", "limit-actions 1, expected 2 as the scenario has it")]:
        near.write_text(text.replace(old, new))
        result = said_by_run(*words, "--resume")
        assert result.returncode == 2 and complaint in result.stderr and path.read_bytes() == kept


def test_command_writes_to_stdout_what_there_is_when_something_failed(near):
    words = (near, "--solver", "rate", "--budget-expansions", 1, "--seed", 4, "--json", "-")
    result = said_by_run(*words, "--tables", "/nowhere/x")
    assert result.returncode == 2 and "/nowhere/x" in result.stderr
    assert [trial["seed"] for trial in json.loads(result.stdout)["trials"]] == [4]
    result = said_by_run(*words, "--true-pose", "9,9,9,0,0,0")
    assert result.returncode == 2 and "outside the prior" in result.stderr and json.loads(result.stdout)["trials"] == []


@pytest.mark.parametrize("options, complaint", [
    (("--json", "--resume"), "--json: found '--resume', expected a value"),
    (("--seed", "--trials", "3"), "--seed: found '--trials', expected a value"),
    (("--json", "-", "--record", "-"), "--record: found what --json writes to"),
    (("--json", "x.json", "--record", "x.json"), "--record: found what --json writes to"),
])
def test_command_refuses_options_that_make_no_sense(options, complaint, tmp_path):
    result = subprocess.run([BUILD / "bin" / "tactus", "run", SHELF, *options], cwd=tmp_path, capture_output=True, text=True, timeout=100)
    assert result.returncode == 2 and complaint in result.stderr and result.stdout == "" and not list(tmp_path.iterdir())

# SPDX-License-Identifier: BSD-3-Clause
"""Several solvers at the same poses: the figures against their definition, phases, and going on after a stop."""

import json
import math
import os
import pathlib
import signal
import statistics
import subprocess
import time

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TACTUS = pathlib.Path(os.environ.get("TACTUS_BUILD", ROOT / "build" / "release")) / "bin" / "tactus"
SOLVERS = ["rate", "tbl", "frontier"]
TRIALS, SEED = 3, 3
CHANGES = [("../../examples", f"{ROOT}/examples"), ("actions: 3", "actions: 8"), ("delta: 400", "delta: 1090\n  particles: 20\n  max_cells: 1000")]

if not TACTUS.exists():
    pytest.skip(f"{TACTUS} is not built", allow_module_level=True)


@pytest.fixture(scope="module")
def shelf(tmp_path_factory):
    """The small shelf, in which one sweep leads from voxels to poses, and some trials end before the plug is in."""
    text = (ROOT / "tests" / "capi" / "small_shelf.yaml").read_text()
    for old, new in CHANGES:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path_factory.mktemp("compare") / "shelf.yaml"
    path.write_text(text)
    return path


def command(shelf, path, *options):
    return [str(word) for word in (TACTUS, "compare", shelf, "--solvers", ",".join(SOLVERS), "--trials", TRIALS, "--seed", SEED,
                                   "--budget-expansions", 1, "--json", path, *options)]


def compare(shelf, path, *options):
    """The results, and what was said."""
    result = subprocess.run(command(shelf, path, *options), capture_output=True, text=True, timeout=250)
    assert result.returncode in (0, 1), result.stderr
    return json.loads(pathlib.Path(path).read_text()), result


@pytest.fixture(scope="module")
def whole(shelf, tmp_path_factory):
    path = tmp_path_factory.mktemp("compare") / "whole.json"
    return path, *compare(shelf, path, "--jobs", 2)


@pytest.fixture(scope="module")
def poses(shelf, tmp_path_factory):
    path = tmp_path_factory.mktemp("compare") / "poses.json"
    return path, *compare(shelf, path, "--phase", "poses", "--jobs", 2)


def timeless(document):
    return [{key: value for key, value in trial.items() if not key.endswith("_s")} for trial in document["trials"]]


def trials_of(document, solver):
    return {trial["seed"]: trial for trial in document["trials"] if trial["solver"] == solver}


# --- what is compared

def test_every_solver_has_the_same_poses(whole):
    _, document, _ = whole
    assert [row["solver"] for row in document["summary"]] == SOLVERS
    assert [(trial["solver"], trial["seed"]) for trial in document["trials"]] == [(s, SEED + i) for s in SOLVERS for i in range(TRIALS)]
    for seed in range(SEED, SEED + TRIALS):
        assert len({tuple(trial["true_pose"]) for trial in document["trials"] if trial["seed"] == seed}) == 1


def test_a_trial_is_the_one_that_run_has(shelf, whole, tmp_path):
    _, document, _ = whole
    path = tmp_path / "run.json"
    subprocess.run([TACTUS, "run", shelf, "--solver", "tbl", "--seed", str(SEED), "--budget-expansions", "1", "--json", path],
                   capture_output=True, timeout=100)
    run = json.loads(path.read_text())
    expected = {"solver": "tbl", **run["trials"][0], "expansions": run["summary"]["expansions"][0], "ended": run["summary"]["ended"][0]}
    found = trials_of(document, "tbl")[SEED]
    assert list(found) == list(expected)
    assert timeless({"trials": [found]}) == timeless({"trials": [expected]})


# --- the figures, from their definition

KEYS = ["cost_m", "travel_m", "rotation_rad", "actions", "planner_calls", "planning_s"]


def taken(trial, phase):
    """What a phase took; None if the trial did not get to its end."""
    before = [trial[f"phase1_{key}"] for key in KEYS]
    whole = [trial[key] for key in KEYS]
    if phase == "voxels":
        return None if None in before else before
    if not trial["inserted"]:
        return None
    return whole if phase == "whole" or None in before else [all_ - first for all_, first in zip(whole, before)]


def student(degrees):
    """The t with 2.5 % beyond it: the density integrated by Simpson's rule, and halving."""
    scale = math.exp(math.lgamma((degrees + 1) / 2) - math.lgamma(degrees / 2)) / math.sqrt(degrees * math.pi)

    def share(t, pieces=2000):
        weights = [1] + [4, 2] * (pieces // 2 - 1) + [4, 1]
        step = t / pieces
        return step / 3 * sum(w * scale * (1 + (i * step) ** 2 / degrees) ** (-(degrees + 1) / 2) for i, w in enumerate(weights))

    low, high = 0.0, 20.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if share(middle) < 0.475 else (low, middle)
    return high


def interval(pairs):
    """Of the ratio of the sums of pairs: about its logarithm, with the covariances of the two means."""
    n = len(pairs)
    means = [sum(pair[i] for pair in pairs) / n for i in (0, 1)]

    def covariance(i, j):
        return sum((pair[i] - means[i]) * (pair[j] - means[j]) for pair in pairs) / (n - 1)

    ratio = means[0] / means[1]
    variance = (covariance(0, 0) - 2 * ratio * covariance(0, 1) + ratio ** 2 * covariance(1, 1)) / n / means[0] ** 2
    half = student(n - 1) * math.sqrt(max(variance, 0.0))
    return ratio * math.exp(-half), ratio * math.exp(half)


def check_standing(row, mine, firsts, phase):
    finished = {seed: taken(trial, phase) for seed, trial in mine.items() if taken(trial, phase)}
    common = [(finished[seed], taken(trial, phase)) for seed, trial in firsts.items() if seed in finished and taken(trial, phase)]
    assert (row["finished"], row["common"]) == (len(finished), len(common))
    for i, key in enumerate(KEYS):
        mean = sum(values[i] for values in finished.values()) / len(finished) if finished else None
        assert row[key] == (mean if mean is None else pytest.approx(mean, rel=1e-7))
    if not common:
        assert all(row[key] is None for key in row if key.endswith(("_ratio", "_low", "_high")))
        return
    cost, calls, planning = [sum(a[i] for a, _ in common) / sum(b[i] for _, b in common) for i in (0, 4, 5)]
    found = [row[key] for key in ("cost_ratio", "calls_ratio", "planning_ratio", "time_per_call_ratio")]
    assert found == pytest.approx([cost, calls, planning, planning / calls], rel=1e-6)
    if len(common) == 1:
        assert row["cost_ratio_low"] is None and row["cost_ratio_high"] is None
    else:
        expected = interval([(a[0], b[0]) for a, b in common])
        assert (row["cost_ratio_low"], row["cost_ratio_high"]) == pytest.approx(expected, rel=1e-5)


def certificate(trials):
    ratios = [trial["poses_value"] / trial["poses_lower_bound"] for trial in trials if trial["poses_lower_bound"]]
    return statistics.median(ratios) if ratios else None


def check_summary(document):
    firsts = trials_of(document, SOLVERS[0])
    for row in document["summary"]:
        mine = trials_of(document, row["solver"])
        assert row["trials"] == len(mine) and row["inserted"] == sum(trial["inserted"] for trial in mine.values())
        assert row["certificate"] == (None if certificate(mine.values()) is None else pytest.approx(certificate(mine.values()), rel=1e-6))
        check_standing(row, mine, firsts, "whole")
        for phase in ("voxels", "poses"):
            check_standing(row["phases"][phase], mine, firsts, phase)


def test_the_summary_follows_from_the_trials(whole, poses):
    for _, document, _ in (whole, poses):
        check_summary(document)
        assert any(row["certificate"] is not None for row in document["summary"])
    rows = whole[1]["summary"]
    assert any(row["common"] < row["finished"] or row["finished"] < TRIALS for row in rows) and rows[1]["common"] >= 2


@pytest.mark.parametrize("degrees, known", [(1, 12.706), (2, 4.303), (5, 2.571), (29, 2.045)])
def test_the_quantiles_of_this_file_are_those_of_the_tables(degrees, known):
    assert student(degrees) == pytest.approx(known, abs=6e-4)


def test_the_table_has_the_figures(whole):
    _, document, result = whole
    first, second = [line.split() for line in result.stdout.split("\nwhole\n")[1].splitlines()[1:3]]
    row = document["summary"][1]
    assert first[:4] == ["rate", str(document["summary"][0]["finished"]), "of", str(TRIALS)] and second[0] == "tbl"
    assert f"{row['cost_ratio']:.2f}" in second and f"{row['cost_ratio_low']:.2f} to {row['cost_ratio_high']:.2f}" in result.stdout


# --- phases

def test_the_phase_of_voxels_ends_at_the_hand_over(shelf, whole, tmp_path):
    document, _ = compare(shelf, tmp_path / "voxels.json", "--phase", "voxels")
    check_summary_of_voxels(document)
    for solver in SOLVERS:
        for seed, trial in trials_of(document, solver).items():
            other = trials_of(whole[1], solver)[seed]
            assert trial["ended"] == "hand-over" and not trial["inserted"]
            for key in ("cost_m", "travel_m", "rotation_rad", "actions", "planner_calls"):
                assert trial[key] == trial[f"phase1_{key}"] == other[f"phase1_{key}"]


def check_summary_of_voxels(document):
    for row in document["summary"]:
        assert (row["inserted"], row["finished"], row["phases"]["poses"]["finished"]) == (0, TRIALS, 0)
        assert {key: row[key] for key in row["phases"]["voxels"]} == row["phases"]["voxels"]


def test_the_phase_of_poses_begins_at_the_hand_over_of_the_first(poses):
    _, document, result = poses
    assert result.stderr.count("rate      led all to: hand-over") == TRIALS
    for row in document["summary"]:
        assert row["phases"]["poses"]["cost_m"] == row["cost_m"] and row["phases"]["voxels"]["cost_m"] is None
    assert all(trial["phase1_cost_m"] is None and trial["actions"] >= 1 for trial in document["trials"])
    assert all(trial["truth_kept"] for trial in document["trials"])


def test_without_a_hand_over_there_is_no_phase_of_poses(shelf, tmp_path):
    stuck = tmp_path / "stuck.yaml"
    stuck.write_text(shelf.read_text().replace("delta: 1090", "delta: 10").replace("actions: 9", "actions: 1"))
    document, _ = compare(stuck, tmp_path / "stuck.json", "--phase", "poses")
    assert {(trial["ended"], trial["actions"]) for trial in document["trials"]} == {("no hand-over", 0)}
    assert all(row["finished"] == 0 and row["cost_m"] is None and row["cost_ratio"] is None for row in document["summary"])


# --- stopping and going on

def kill_after(trials, words, path):
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while not path.exists() or path.read_text().count('{"solver": ') < len(SOLVERS) + trials:
        assert process.poll() is None
        time.sleep(0.005)
    process.kill()
    assert process.wait(20) == -signal.SIGKILL
    process.stderr.close()


def check_goes_on(shelf, path, uninterrupted, *options):
    kept = json.loads(path.read_text())["trials"]
    assert 0 < len(kept) < len(uninterrupted["trials"])
    document, result = compare(shelf, path, "--resume", *options)
    check_summary(document)
    assert timeless(document) == timeless(uninterrupted)
    return kept, document, result


def test_an_interrupted_comparison_goes_on_where_it_was(shelf, whole, tmp_path):
    path = tmp_path / "results.json"
    kill_after(4, command(shelf, path), path)
    kept, document, result = check_goes_on(shelf, path, whole[1])
    assert f"{len(kept)} of {TRIALS * len(SOLVERS)} trials are there" in result.stderr
    assert all(trial in document["trials"] for trial in kept)


def test_the_phase_of_poses_goes_on_with_poses_that_all_solvers_played(shelf, poses, tmp_path):
    path = tmp_path / "results.json"
    kill_after(4, command(shelf, path, "--phase", "poses"), path)
    kept, document, result = check_goes_on(shelf, path, poses[1], "--phase", "poses")
    whole_poses = len(kept) // len(SOLVERS)
    assert f"{whole_poses * len(SOLVERS)} of {TRIALS * len(SOLVERS)} trials are there" in result.stderr
    assert [trial in document["trials"] for trial in kept if trial["seed"] < SEED + whole_poses] == [True] * whole_poses * len(SOLVERS)


def test_a_finished_comparison_runs_nothing(shelf, whole, tmp_path):
    path = tmp_path / "results.json"
    path.write_bytes(whole[0].read_bytes())
    document, result = compare(shelf, path, "--resume")
    assert "ended:" not in result.stderr
    assert document["trials"] == whole[1]["trials"]


@pytest.mark.parametrize("name", ["sim_5d", "shelf_3d", "shelf_3d_more", "sim_5d_voxels", "sim_5d_poses"])
def test_kept_results_can_be_gone_on_with(name, tmp_path):
    kept = (ROOT / "examples" / "results" / f"{name}.json").read_text()
    path = tmp_path / "kept.json"
    path.write_text(kept)
    document = json.loads(kept)
    count = len(document["trials"])
    seed = min(trial["seed"] for trial in document["trials"])
    result = subprocess.run([str(word) for word in (
        TACTUS, "compare", ROOT / "examples" / "scenarios" / f"{document['scenario']}.yaml", "--solvers", document["solvers"], "--belief",
        document["belief"], "--phase", document["phase"], "--trials", count // len(document["summary"]), "--seed", seed,
        "--budget-seconds", document["options"]["budget_seconds"], "--resume", "--json", path)], capture_output=True, text=True, timeout=100)
    assert result.returncode == 0 and f"{count} of {count} trials are there" in result.stderr
    assert json.loads(path.read_text())["trials"] == document["trials"]


def test_a_comparison_goes_on_with_another_solver(shelf, whole, tmp_path):
    path = tmp_path / "results.json"
    compare(shelf, path, "--solvers", "frontier,rate")
    document, result = compare(shelf, path, "--resume")
    check_summary(document)
    assert f"{2 * TRIALS} of {3 * TRIALS} trials are there" in result.stderr
    ended = [line for line in result.stderr.splitlines() if "ended:" in line]
    assert len(ended) == TRIALS and all("tbl" in line for line in ended)
    assert timeless(document) == timeless(whole[1])


@pytest.mark.parametrize("options, complaint", [
    (("--budget-expansions", 2), "budget-expansions 1, expected 2"),
    (("--solvers", "rate,tbl"), 'solver "rate,tbl,frontier", expected "rate,tbl"'),
    (("--phase", "voxels"), 'phase "whole", expected "voxels"'),
    (("--trials", 2), "a trial of seed 5, expected 2 seeds from 3 on"),
])
def test_other_options_are_refused_by_name(shelf, whole, options, complaint):
    path = whole[0]
    before = path.read_bytes()
    result = subprocess.run(command(shelf, path, "--resume", *options), capture_output=True, text=True, timeout=100)
    assert result.returncode == 2 and complaint in result.stderr and "ended:" not in result.stderr
    assert path.read_bytes() == before


@pytest.mark.parametrize("solvers", ["rate,tbl,frontier,rtdp-bel", "tbl,rate,frontier", "rate,tbl"])
def test_the_phase_of_poses_goes_on_with_the_same_solvers_only(shelf, poses, solvers):
    path = poses[0]
    before = path.read_bytes()
    result = subprocess.run(command(shelf, path, "--phase", "poses", "--resume", "--solvers", solvers), capture_output=True, text=True, timeout=100)
    assert result.returncode == 2 and "ended:" not in result.stderr and path.read_bytes() == before
    assert f'solver "rate,tbl,frontier", expected "{solvers}"' in result.stderr and "beliefs that were not kept" in result.stderr


@pytest.mark.parametrize("old, new, complaint", [
    ("xyz: [1.004, 0.05, 0.55]", "xyz: [1.004, 0.051, 0.55]", "a trial of seed 3 with the target at [1.004,"),
    ("width: {y: 0.04", "width: {y: 0.05", "a trial of seed 3 with the target at [1.004,"),
    ("limits: {", "cost: {radian: 0.1}\nlimits: {", "cost-radian 0.05, expected 0.1 as the scenario has it"),
    ("actions: 8", "actions: 9", "limit-actions 8, expected 9 as the scenario has it"),
    ("limits: {", "limits: {travel: 5, ", "limit-travel 60, expected 5 as the scenario has it"),
    ("limits: {", "limits: {seconds: 500, ", "limit-seconds 600, expected 500 as the scenario has it"),
])
def test_another_scenario_of_the_same_name_is_refused(shelf, whole, old, new, complaint, tmp_path):
    other = tmp_path / "shelf.yaml"
    other.write_text(shelf.read_text().replace(old, new, 1))
    assert other.read_text() != shelf.read_text()
    path = whole[0]
    before = path.read_bytes()
    result = subprocess.run(command(other, path, "--resume"), capture_output=True, text=True, timeout=100)
    assert result.returncode == 2 and complaint in result.stderr and "ended:" not in result.stderr
    assert path.read_bytes() == before


def test_results_of_before_costs_and_limits_were_told_are_taken(shelf, whole, tmp_path):
    path = tmp_path / "results.json"
    told = ', "cost_metre": 1, "cost_radian": 0.05, "cost_action": 0.005, "limit_actions": 8, "limit_travel": 60, "limit_seconds": 600'
    assert told in whole[0].read_text()
    path.write_text(whole[0].read_text().replace(told, ""))
    document, result = compare(shelf, path, "--resume")
    assert "ended:" not in result.stderr and [document[key] for key in ("options", "trials")] == [whole[1][key] for key in ("options", "trials")]


@pytest.mark.parametrize("damage, complaint", [
    (lambda text: text[:len(text) // 2], "found "),
    (lambda text: text.replace('"summary": [', '"summary": ]', 1), "found ']"),
    (lambda text: text.replace('{"solver": "tbl", "seed": 4', '{"solver": "tbl", "seed": 3', 1), "order of their seeds"),
    (lambda text: text.replace('{"solver": "tbl", "seed"', '{"solver": "rtdp-ad", "seed"', 1), "one of the solvers named above"),
    (lambda text: text + "{", "expected the end of the file"),
])
def test_a_damaged_file_is_refused_and_left_alone(shelf, whole, damage, complaint, tmp_path):
    path = tmp_path / "results.json"
    path.write_text(damage(whole[0].read_text()))
    before = path.read_bytes()
    assert before != whole[0].read_bytes()
    result = subprocess.run(command(shelf, path, "--resume"), capture_output=True, text=True, timeout=100)
    assert result.returncode == 2 and complaint in result.stderr and path.read_bytes() == before


# --- what can't be compared

@pytest.mark.parametrize("options, complaint", [
    (("--belief", "particles", "--phase", "poses"), "no voxels"),
    (("--solvers", "rate,magic"), "magic"),
])
def test_what_cannot_be_compared_is_said(shelf, tmp_path, options, complaint):
    result = subprocess.run(command(shelf, tmp_path / "x.json", *options), capture_output=True, text=True, timeout=100)
    assert result.returncode == 2 and complaint in result.stderr and "ended:" not in result.stderr


# --- trials that fail

COLLIDING = 4  # a seed at which the target touches the robot at its start


@pytest.fixture(scope="module")
def near(shelf, tmp_path_factory):
    """The target is so near that it touches the robot at some poses, and there is time to insert the plug at others."""
    text = shelf.read_text()
    for old, new in [("xyz: [1.004, 0.05, 0.55]", "xyz: [0.68, 0.05, 0.5]"), ("width: {y: 0.04", "width: {y: 0.3"), ("actions: 8", "actions: 40")]:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path_factory.mktemp("near") / "near.yaml"
    path.write_text(text)
    return path


def check_failed(trial):
    assert (trial["ended"], trial["inserted"]) == ("error", False)
    assert all(trial[key] is None for key in KEYS)


def test_a_trial_that_cannot_begin_fails_alone(near, tmp_path):
    path = tmp_path / "results.json"
    options = ("--solvers", "rate,tbl", "--belief", "particles", "--seed", COLLIDING, "--trials", 2)
    document, result = compare(near, path, *options)
    assert result.returncode == 1
    assert result.stderr.count("START_IN_COLLISION") == 2 and "a target that the robot touches at its start" in result.stderr
    for solver in ("rate", "tbl"):
        trials = trials_of(document, solver)
        check_failed(trials[COLLIDING])
        assert trials[COLLIDING + 1]["inserted"]
    check_summary(document)
    assert all(row["finished"] == row["common"] == 1 and row["cost_ratio"] > 0 for row in document["summary"])
    again, result = compare(near, path, "--resume", *options)
    assert again["trials"] == document["trials"] and result.returncode == 1 and "ended:" not in result.stderr


def test_where_the_first_solver_cannot_lead_all_fail(near, tmp_path):
    document, result = compare(near, tmp_path / "results.json", "--phase", "poses", "--seed", COLLIDING, "--trials", 1)
    assert result.returncode == 1 and "led all to: error" in result.stderr
    for trial in document["trials"]:
        check_failed(trial)


def test_results_go_to_stdout_also_when_tables_cannot_be_saved(near):
    words = command(near, "-", "--solvers", "rate,tbl", "--belief", "particles", "--seed", COLLIDING, "--trials", 1, "--tables", "/nowhere/x")
    result = subprocess.run(words, capture_output=True, text=True, timeout=100)
    assert result.returncode == 2 and "/nowhere/x" in result.stderr
    for trial in json.loads(result.stdout)["trials"]:
        check_failed(trial)

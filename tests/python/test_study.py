# SPDX-License-Identifier: BSD-3-Clause
"""Many trials: stopped at any moment, gone on with, several at a time, and put into a table, with the same results."""

import json
import re
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TACTUS = pathlib.Path(os.environ.get("TACTUS_BUILD", ROOT / "build" / "release")) / "bin" / "tactus"
SHELF = ROOT / "tests" / "capi" / "small_shelf.yaml"
TRIALS = 3

if not TACTUS.exists():
    pytest.skip(f"{TACTUS} is not built", allow_module_level=True)

sys.path.insert(0, str(ROOT / "examples" / "python"))
import study  # noqa: E402


def command(path, *options):
    return [str(word) for word in (TACTUS, "run", SHELF, "--trials", TRIALS, "--seed", 3, "--budget-expansions", 2, "--json", path,
                                   *options)]


def run(path, *options):
    result = subprocess.run(command(path, *options), capture_output=True, text=True, timeout=120)
    assert result.returncode in (0, 1), result.stderr
    return result


def refused(path, *options):
    """What the command says when it does not go on with a file; the file is left as it is."""
    before = path.read_bytes()
    result = subprocess.run(command(path, "--resume", *options), capture_output=True, text=True, timeout=120)
    assert result.returncode == 2 and path.read_bytes() == before
    assert str(path) in result.stderr and "ended:" not in result.stderr
    return result.stderr


def trial_lines(path):
    """The trials as they are written, a line each."""
    return [line.rstrip(",") for line in path.read_text().splitlines() if line.startswith('    {"seed"')]


def timeless(path):
    """The trials but for times."""
    return [re.sub(r'"\w*_s": [^,}]*', "", line) for line in trial_lines(path)]


@pytest.fixture(scope="module")
def in_one_go(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "one.json"
    run(path)
    assert len(timeless(path)) == TRIALS
    return path


def kill_after_a_trial(path):
    process = subprocess.Popen(command(path), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    while not path.exists() or not trial_lines(path):
        assert process.poll() is None
        time.sleep(0.005)
    process.kill()
    assert process.wait(20) == -signal.SIGKILL
    process.stderr.close()


def test_an_interrupted_run_goes_on_where_it_was(in_one_go, tmp_path):
    path = tmp_path / "results.json"
    kill_after_a_trial(path)
    kept = trial_lines(path)
    assert 1 <= len(kept) < TRIALS and json.loads(path.read_text())["summary"]["trials"] == len(kept)
    result = run(path, "--resume")
    assert "seed 3 " not in result.stderr and f"{len(kept)} of {TRIALS} trials are there" in result.stderr
    assert trial_lines(path)[:len(kept)] == kept
    assert timeless(path) == timeless(in_one_go)
    check_summaries(json.loads(in_one_go.read_text())["summary"], json.loads(path.read_text())["summary"])
    assert result.stdout.count("limit of actions") == TRIALS


def check_summaries(one, other):
    """The same but for times, and for the ninth digit of a mean."""
    assert list(one) == list(other)
    for key in one:
        if not key.endswith("_s"):
            assert other[key] == (pytest.approx(one[key], rel=1e-8) if key.startswith("mean_") else one[key])


def test_trials_at_a_time_give_the_same_results(in_one_go, tmp_path):
    path = tmp_path / "results.json"
    said = run(path, "--jobs", 2).stderr.splitlines()
    assert timeless(path) == timeless(in_one_go)
    assert all(line.startswith(("seed ", "loading ")) for line in said)
    first_end = next(i for i, line in enumerate(said) if "ended:" in line)
    assert len({line.split()[1] for line in said[1:first_end]}) == 2


@pytest.mark.parametrize("options, complaint", [
    (("--budget-expansions", 1), "budget-expansions 2, expected 1"),
    (("--belief", "particles"), 'belief "hierarchical", expected "particles"'),
    (("--stopping-distance", 0.001), "stopping-distance null, expected 0.001"),
    (("--trials", 2), "a trial of seed 5, expected 2 seeds from 3 on"),
])
def test_other_options_are_refused_by_name(options, complaint, in_one_go):
    assert complaint in refused(in_one_go, *options)


@pytest.mark.parametrize("damage, complaint", [
    (lambda text: text[:len(text) // 2], "found "),
    (lambda text: "", "found the end of the file, expected {"),
    (lambda text: text.replace('"inserted": false', '"inserted": 0', 1), "found '0, "),
    (lambda text: text.replace('"seed": 4', '"seed": 3', 1), "order of their seeds"),
    (lambda text: text.replace('"actions": 3', '"actions": -3', 1), "expected a whole number"),
    (lambda text: text.replace('"limit of actions"', '"tired"', 1), "a way in which a trial ends"),
    (lambda text: text + "{", "expected the end of the file"),
])
def test_a_damaged_file_is_refused_and_left_alone(damage, complaint, in_one_go, tmp_path):
    path = tmp_path / "results.json"
    path.write_text(damage(in_one_go.read_text()))
    assert path.read_text() != in_one_go.read_text()
    assert complaint in refused(path)


def test_resume_takes_a_file_that_keeps():
    for options in (["--resume"], ["--resume", "--json", "-"], ["--resume", "--json", "/dev/null"]):
        result = subprocess.run([TACTUS, "run", SHELF, *options], capture_output=True, text=True, timeout=20)
        assert result.returncode == 2 and "--resume: expected --json" in result.stderr


# --- the study of the examples

def test_the_table_has_a_row_for_each_setting_with_results(in_one_go, tmp_path, monkeypatch):
    monkeypatch.setattr(study, "STUDY", tmp_path)
    shutil.copy(in_one_go, tmp_path / "base_4d.json")
    document = json.loads(in_one_go.read_text())
    inserted = sum(trial["inserted"] for trial in document["trials"])
    document["trials"] = [{**document["trials"][0], "cost_m": cost, "inserted": cost < 2} for cost in (1.0, 1.5, 6.5)]
    (tmp_path / "shelf_3d.json").write_text(json.dumps(document))
    study.write_table(tmp_path / "table.md")
    shelf, base = [line for line in (tmp_path / "table.md").read_text().splitlines() if line.startswith(("| shelf_3d", "| base_4d", "| sim_5d"))]
    assert shelf.startswith("| shelf_3d | 3 | 2 (66.7 %) | 3 (100.0 %) | 3.00 | 1.50 | 6.50 | 3.0 | ")
    assert base.startswith(f"| base_4d | {TRIALS} | {inserted} ({100.0 * inserted / TRIALS:.1f} %) |")


def test_the_study_runs_scenarios_that_are_there():
    for setting in study.SETTINGS:
        words = study.command(setting, 1, 5)
        assert (ROOT / words[2]).exists() and "--resume" in words and words[words.index("--trials") + 1] == str(setting.trials)
    assert sum(setting.trials for setting in study.SETTINGS[:3]) == 1000


def test_a_trial_that_could_not_begin_counts_as_one_and_for_no_mean():
    begun = {"inserted": True, "truth_kept": True, "cost_m": 2.0, "actions": 10, "planner_calls": 10, "planning_s": 5.0}
    never = {"inserted": False, "truth_kept": True, "cost_m": None, "actions": None, "planner_calls": None, "planning_s": None}
    assert study.row("two", [begun, never]) == "| two | 2 | 1 (50.0 %) | 2 (100.0 %) | 2.00 | 2.00 | 2.00 | 10.0 | 10.0 | 5.0 |\n"
    assert study.row("none", [never]) == "| none | 1 | 0 (0.0 %) | 1 (100.0 %) | - | - | - | - | - | - |\n"

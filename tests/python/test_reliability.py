# SPDX-License-Identifier: BSD-3-Clause
"""Forecasts of contacts against what happened: the scores, and the command that collects them."""

import json
import math
import pathlib
import random
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHELF = ROOT / "tests" / "capi" / "small_shelf.yaml"
sys.path.insert(0, str(ROOT / "examples" / "python"))
import reliability  # noqa: E402


# --- scores

def drawn(seed, count=500):
    """Forecasts, bounds of the bins among them, and outcomes that are not what they say."""
    rng = random.Random(seed)
    forecasts = [rng.choice([rng.random(), rng.randrange(11) / 10]) for _ in range(count)]
    return forecasts, [rng.random() < forecast ** 2 for forecast in forecasts]


def plain_bins(forecasts, happened):
    """By bin its cases, sorted by hand."""
    sorted_in = {}
    for forecast, contact in zip(forecasts, happened):
        number = next(b for b in range(10) if b == 9 or forecast * 10 < b + 1)
        sorted_in.setdefault(number, []).append((forecast, contact))
    return sorted_in


@pytest.mark.parametrize("seed", range(5))
def test_bins_hold_every_case_once(seed):
    forecasts, happened = drawn(seed)
    expected = plain_bins(forecasts, happened)
    found = reliability.bins(forecasts, happened)
    assert [b.low for b in found] == [number / 10 for number in sorted(expected)]
    for b, cases in zip(found, (expected[number] for number in sorted(expected))):
        assert b.count == len(cases)
        assert b.mean == pytest.approx(sum(forecast for forecast, _ in cases) / len(cases))
        assert b.share == pytest.approx(sum(contact for _, contact in cases) / len(cases))


@pytest.mark.parametrize("seed", range(5))
def test_scores_are_their_sums(seed):
    forecasts, happened = drawn(seed)
    squares = sum((forecast - contact) ** 2 for forecast, contact in zip(forecasts, happened))
    gaps = sum(abs(sum(forecast - contact for forecast, contact in cases)) for cases in plain_bins(forecasts, happened).values())
    assert reliability.brier(forecasts, happened) == pytest.approx(squares / len(forecasts))
    assert reliability.calibration_error(forecasts, happened) == pytest.approx(gaps / len(forecasts))


def test_a_forecast_that_is_right_has_no_error():
    assert reliability.calibration_error([0.25] * 4, [True, False, False, False]) == pytest.approx(0)
    assert reliability.brier([0, 1], [False, True]) == 0


@pytest.mark.parametrize("contacts, count", [(0, 1), (1, 1), (0, 10), (3, 10), (5, 10), (10, 10), (17, 400), (399, 400)])
def test_wilson_bounds_are_the_shares_from_which_the_sample_is_just_196_deviations_off(contacts, count):
    share = contacts / count
    low, high = reliability.wilson(share, count)
    assert 0 <= low <= share + 1e-12 and share - 1e-12 <= high <= 1
    for bound in (low, high):
        assert abs(share - bound) == pytest.approx(1.959964 * math.sqrt(bound * (1 - bound) / count), abs=1e-7)


# --- the command

def words(folder, trials, *options):
    return [str(word) for word in ("--scenario", SHELF, "--trials", trials, "--seed", 3, "--expansions", 1, "--folder", folder, *options)]


@pytest.fixture(scope="module")
def in_one_go(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reliability")
    reliability.main(words(folder, 2))
    return folder


def test_both_likelihoods_judge_what_either_plays(in_one_go):
    document = json.loads((in_one_go / "small_shelf.json").read_text())
    assert [(e["player"], e["seed"]) for e in document["episodes"]] == [("paper", 3), ("paper", 4), ("calibrated", 3), ("calibrated", 4)]
    for episode in document["episodes"]:
        assert 1 <= sum(action["played"] for action in episode["judged"]) <= 3 and episode["judged"][0]["played"]
        for action in episode["judged"]:
            assert all(0 <= action[key] <= 1 for key in ("planned", "paper", "calibrated")) and isinstance(action["contact"], bool)


def test_the_page_says_how_often_what_was_forecast_happened(in_one_go):
    page = (in_one_go / "small_shelf.md").read_text()
    assert "| played with paper | paper, as planned | " in page and "| played with calibrated | paper | " in page
    for heading in ("## paper, as planned: played with paper", "## calibrated, as planned: played with calibrated", "## paper: all", "## calibrated: all"):
        assert heading in page
    assert (in_one_go / "small_shelf.png").read_bytes().startswith(b"\x89PNG")


def test_an_interrupted_run_goes_on_where_it_was(in_one_go, tmp_path, monkeypatch, capsys):
    played, play = [], reliability.play

    def interrupted(scenario, likelihood, seed, expansions):
        if len(played) == 3:
            raise KeyboardInterrupt
        played.append((likelihood, seed))
        return play(scenario, likelihood, seed, expansions)

    monkeypatch.setattr(reliability, "play", interrupted)
    with pytest.raises(SystemExit, match="goes on from here"):
        reliability.main(words(tmp_path, 2))
    assert len(json.loads((tmp_path / "small_shelf.json").read_text())["episodes"]) == 3
    monkeypatch.setattr(reliability, "play", play)
    capsys.readouterr()
    reliability.main(words(tmp_path, 2))
    said = capsys.readouterr()
    assert "3 are there" in said.err and said.err.count("of 4 episodes") == 1
    for name in ("small_shelf.json", "small_shelf.md"):
        assert (tmp_path / name).read_text() == (in_one_go / name).read_text()
    assert said.out == (in_one_go / "small_shelf.md").read_text()


def test_other_expansions_are_refused_and_the_file_left_alone(in_one_go):
    before = (in_one_go / "small_shelf.json").read_bytes()
    with pytest.raises(SystemExit, match="found --expansions 1, expected 2"):
        reliability.main(words(in_one_go, 2, "--expansions", 2))
    assert (in_one_go / "small_shelf.json").read_bytes() == before


@pytest.mark.parametrize("option, value", [("--trials", "0"), ("--seed", "-1"), ("--expansions", "many"), ("--likelihood", "mine"), ("--scenario", "nowhere")])
def test_what_makes_no_sense_is_named(option, value, capsys):
    with pytest.raises(SystemExit) as ended:
        reliability.arguments([option, value])
    said = capsys.readouterr().err
    assert ended.value.code == 2 and option in said and value in said


def test_a_page_of_one_player_has_no_rows_of_the_other(in_one_go):
    document = json.loads((in_one_go / "small_shelf.json").read_text())
    document["episodes"] = [episode for episode in document["episodes"] if episode["player"] == "paper"]
    page = reliability.page(reliability.arguments(words(in_one_go, 2)), document)
    assert "| played with paper | calibrated | " in page and "played with calibrated" not in page

"""Plans: from files and dicts, changed, checked, drawn, simulated; and what is said where they are wrong."""

from __future__ import annotations

import _thread
import logging
import re
import signal
import threading
import time
import tomllib
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from conftest import REPOSITORY, START, command

import spindrift as sd


def without_description(text: str) -> str:
    """A dict has no comments, from which a file's description may come."""
    return re.sub(r"(?m)^description = .*\n", "", text)


@pytest.mark.parametrize("file", sorted((REPOSITORY / "campaigns").glob("*.toml")), ids=lambda file: file.stem)
def test_a_dict_is_a_file(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Law: of every shipped campaign, the plan of its tables as a dict is the plan of the file."""
    monkeypatch.chdir(file.parent)  # paths in a dict count from the current folder
    tables = tomllib.loads(file.read_text())
    assert without_description(sd.Plan(tables).text) == without_description(sd.load(file).text)


def test_set_is_the_option_of_the_command_line() -> None:
    """Law: numbers, texts with units, lists, truth values and what NumPy makes of them mean what they mean in a file."""
    plan = sd.load(START)
    for key, value, written in [
        ("campaign.duration_s", 20, "duration_s = 20"),
        ("campaign.duration_s", np.float64(20), "duration_s = 20"),
        ("campaign.seed", np.int64(7), "seed = 7"),
        ("wheels.w1.rate_rad_s", 12.5, "rate_rad_s = 12.5"),
        ("initial.angular_velocity_rad_s", np.array([0.0, 0.25, 0.5]), "angular_velocity_rad_s = [0.0, 0.25, 0.5]"),
        ("initial.angular_velocity_rad_s", (0, 0.25, 0.5), "angular_velocity_rad_s = [0.0, 0.25, 0.5]"),
        ("body.includes_wheels", True, "includes_wheels = true"),
        ("disperse[1].std", "10 rpm", "std = 1.047"),
        ("campaign.name", "5", 'name = "5"'),
    ]:
        changed = plan.set({key: value}).text
        assert written in changed, (key, changed)
        assert changed != plan.text
    both = plan.set({"campaign.seed": 3, "campaign.samples": 77})
    assert (both.samples, both.name, both.duration_s) == (77, "start", 60.0)
    assert plan.samples == 1000, "a plan does not change"
    assert repr(both) == "<spindrift.Plan start: 77 runs of 60 s>"


def test_a_wrong_file_has_all_lines_of_the_command_line(tmp_path: Path) -> None:
    """Law: every problem, with line, key, value, allowed range and remedy: what the command prints after `error: `."""
    wrong = START.read_text().replace("mass_kg = 180.0", "mass_kg = -180.0").replace("samples = 1000", "samplse = 10")
    (tmp_path / "wrong.toml").write_text(wrong)
    with pytest.raises(sd.SpindriftError) as raised:
        sd.load(tmp_path / "wrong.toml")
    said = str(raised.value)
    assert "samplse" in said and "mass_kg" in said and "-180" in said
    done = command("check", str(tmp_path / "wrong.toml"))
    assert done.returncode == 2 and done.stderr.strip() == f"error: {said}".strip()


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({}, ["campaign is missing", "body is missing"]),
        ({"campaign": {"seed": None}}, ["campaign.seed = None", "a number, a text"]),
        ({"campaign": {"seed": 2**70}}, ["campaign.seed", "64 bits"]),
        ({"disperse": [{"std": {1, 2}}]}, ["disperse[0].std", "must be"]),
        ({"campaign": {1: 2}}, ["campaign = 1", "texts as keys"]),
        ({"campaign": {"name": "x", "samples": 0, "seed": 1, "duration_s": -5}}, ["samples", "duration_s"]),
    ],
)
def test_a_wrong_dict_is_refused(tables: dict[str, object], words: list[str]) -> None:
    with pytest.raises(sd.SpindriftError) as raised:
        sd.Plan(tables)
    for word in words:
        assert word in str(raised.value), str(raised.value)


def nest(depth: int, inner: object, as_list: bool) -> object:
    for _ in range(depth):
        inner = [inner] if as_list else {"a": inner}
    return inner


def test_values_without_an_end_are_refused() -> None:
    """Law: a list or dict that contains itself, or has thousands within it, is refused with the key and the limit; one of few is read."""
    own_list: list[object] = [1.0]
    own_list.append(own_list)
    own_dict: dict[str, object] = {}
    own_dict["a"] = own_dict
    plan = sd.load(START)
    for value in (own_list, own_dict, nest(20_000, 1, True), nest(20_000, 1, False), nest(70, 1, True)):
        for call in (lambda: sd.Plan({"campaign": value}), lambda: plan.set({"campaign.duration_s": value})):
            with pytest.raises(sd.SpindriftError, match="campaign: must be at most 64 lists and dicts within each other"):
                call()
    with pytest.raises(sd.SpindriftError, match="duration_s"):
        plan.set({"campaign.duration_s": nest(20, 1, True)})


def test_numbers_of_numpy_that_python_has_not() -> None:
    """Law: a long double is the nearest double, alone and in arrays; a complex one is refused, and so are dates."""
    plan = sd.load(START)
    for value in (np.longdouble("20.5"), np.array(20.5, dtype=np.longdouble)):
        assert "duration_s = 20.5" in plan.set({"campaign.duration_s": value}).text
    rate = np.array([0.0, 0.25, 0.5], dtype=np.longdouble)
    assert "= [0.0, 0.25, 0.5]" in plan.set({"initial.angular_velocity_rad_s": rate}).text
    for value in (np.clongdouble(1 + 2j), np.complex128(1), np.datetime64("2026-01-01"), np.array([object()])):
        with pytest.raises(sd.SpindriftError, match="must be a number"):
            plan.set({"campaign.duration_s": value})


def test_more_samples_than_memory_are_refused_and_others_stop() -> None:
    """Law: what does not fit is refused with both sizes before anything is drawn; what takes long ends at Ctrl-C."""
    plan = sd.load(START)
    with pytest.raises(sd.SpindriftError, match=r"1000000000000 samples of start: .* of memory: the machine has .* left"):
        plan.sample(10**12)
    # a shell that starts tests in the background has SIGINT ignored
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.05, _thread.interrupt_main).start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        plan.sample(20_000_000)
    assert time.monotonic() - begun < 5


def test_what_is_not_there_is_refused(tmp_path: Path) -> None:
    plan = sd.load(START)
    for call, words in [
        (lambda: sd.load(tmp_path / "none.toml"), "there is no campaign file"),
        (lambda: plan.set({"wheels.w9.rate_rad_s": 1}), "w9"),
        (lambda: plan.set({"campaign.samplse": 1}), "samplse"),
        (lambda: plan.simulate(sample=1000), "0 to 999"),
        (lambda: plan.simulate(times=[-1.0]), "-1"),
        (lambda: plan.run(samples=0), "from 1 to"),
        (lambda: plan.run(threads=10_000), "threads=10000"),
        (lambda: sd.open(tmp_path), "no such folder, or it is empty"),
        (lambda: sd.compare(tmp_path, tmp_path), "no such folder, or it is empty"),
    ]:
        with pytest.raises(sd.SpindriftError) as raised:
            call()
        assert words in str(raised.value), str(raised.value)
    for call in (lambda: plan.run(samples="many"), lambda: plan.run(samples=-1), lambda: plan.simulate(sample=1.5)):
        with pytest.raises((TypeError, OverflowError)):
            call()  # type: ignore[no-untyped-call]


def test_check_says_what_the_command_says() -> None:
    """Law: word by word, but for the measured times, the runs that were timed, and the memory."""
    check = sd.load(START).check()
    printed = command("check", str(START)).stdout
    timed = re.compile(r"[0-9.]+(e-?\d+)? (ms|s)\b|from \d+ runs?|memory: at most [0-9.]+ .?B")

    def words(text: str) -> str:
        return timed.sub("", " ".join(text.split()))

    assert words(str(check)) == words(printed)
    assert "1000 runs of 60 s" in str(check)
    assert check._repr_html_().startswith("<pre>") and "&lt;" in sd.Check("a < b")._repr_html_()
    assert "500 runs of 60 s" in str(sd.load(START).check(samples=500))


def test_samples_are_those_of_the_rows(results: sd.Results) -> None:
    """Law: what is drawn without runs is what the rows applied."""
    drawn = pl.DataFrame(sd.load(START).sample(300))
    rows = pl.DataFrame(results.rows)
    names = [name for name in drawn.columns if name.startswith(("initial_", "wheels_")) and name in rows.columns]
    assert drawn.height == 300 and names
    assert drawn.select(names).equals(rows.select(names))
    assert drawn["mass_kg"][0] == 185.0 and set(drawn["status"]) == {"drawn"}


def test_a_sample_over_time_is_its_row(results: sd.Results, caplog: pytest.LogCaptureFixture) -> None:
    """Law: the series of sample 17 ends where its row does, bit for bit; so does that of the plan, at other times too."""
    rows, series = pl.DataFrame(results.rows), pl.DataFrame(results.series(17))
    assert series.height == 121 and series["time_s"][-1] == 60.0
    for axis in "xyz":
        assert series[f"omega_se_s_{axis}_rad_s"][-1] == rows[f"omega_se_s_{axis}_final_rad_s"][17]
    plan = sd.load(START)
    assert pl.DataFrame(plan.simulate(sample=17)).equals(series)
    assert not pl.DataFrame(plan.simulate(sample=16)).equals(series)
    times = np.linspace(0, 60, 7)
    few = pl.DataFrame(plan.simulate(sample=17, times=times))
    assert few["time_s"].to_list() == times.tolist()
    near = few["omega_se_s_x_rad_s"] - series["omega_se_s_x_rad_s"].gather_every(20)
    assert near.abs().max() < 1e-12  # type: ignore[operator]
    with caplog.at_level(logging.WARNING, "spindrift"):
        failed = plan.set({"integrator.max_steps": 1}).simulate(sample=3)
    assert len(failed) < 121 and "step_limit" in caplog.text


def test_columns() -> None:
    columns = pl.DataFrame(sd.columns())
    assert columns.columns == ["group", "name", "unit", "meaning", "only"]
    angle = columns.filter(pl.col("name") == "spin_axis_angle_max_rad")
    assert angle["unit"].to_list() == ["rad"] and angle["group"].to_list() == ["attitude"]

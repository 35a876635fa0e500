"""Laws of attitude in Python."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from conftest import REPOSITORY, command

import spindrift as sd

STIFFNESS, DAMPING = 3.5, 30.0


def plan(law: str = "python", **campaign: Any) -> sd.Plan:
    """The loop of the comparison with Basilisk, for 30 s, under `law`; half of the samples fly a second phase from 10 s on."""
    tables = tomllib.loads((REPOSITORY / "benches" / "peers" / "basilisk_attitude.toml").read_text())
    tables["campaign"] |= {"duration_s": 30.0, "samples": 150} | campaign
    gains = {} if law == "python" else {"stiffness_n_m": STIFFNESS, "damping_n_m_s": DAMPING}
    first, second = tables["guidance"][0], dict(tables["guidance"][0])
    for phase in (first, second):
        for key in ("stiffness_n_m", "damping_n_m_s"):
            del phase[key]
        phase |= {"law": law} | gains
    first |= {"until": "time_s > 10", "next": "again"}
    second |= {"phase": "again", "attitude": [0.999, 0.0, 0.0, 0.0447]}
    tables["guidance"] = [first, second]
    return sd.Plan(tables)


def mrp_feedback(tick: sd.Tick) -> Any:
    """u = -K s - P omega, as the built-in law computes it at a target at rest."""
    error = np.where(tick.error[:, :1] < 0.0, -tick.error, tick.error)
    mrp = (1.0 / (1.0 + error[:, :1])) * error[:, 1:]
    return -(STIFFNESS * mrp + DAMPING * (tick.rate_rad_s - tick.target_rate_rad_s))


def test_the_same_operations_give_the_same_rows(tmp_path: Path) -> None:
    """Law: a law in Python flies what the built-in one flies, bit for bit, on one thread and on two, in both phases."""
    built_in = pl.DataFrame(plan("mrp_feedback").run(threads=2).rows)
    for threads in (1, 2):
        results = plan().run(control=mrp_feedback, threads=threads, out=tmp_path / str(threads))
        rows = pl.DataFrame(results.rows)
        assert rows.equals(built_in)
        assert set(rows["phase_again_begin_s"].is_not_null()) == {True}
    # the same run over time, the page's replay, and a result that is opened again
    series = pl.DataFrame(results.series(17))
    assert series.equals(pl.DataFrame(plan("mrp_feedback").simulate(17)))
    assert "is a function of Python" in (results.path / "report.html").read_text()
    again = sd.open(results.path, control=mrp_feedback)
    assert pl.DataFrame(again.series(17)).equals(series)


def test_a_law_is_asked_for_all_runs_that_wait() -> None:
    """Law: every tick of every run is asked about once, three times for the eight that measure the loop; runs that fly side by side in one call; what a law remembers by sample is that run's."""
    ticks: dict[int, list[float]] = {}
    sizes: list[int] = []

    def control(tick: sd.Tick) -> Any:
        sizes.append(len(tick))
        for sample, time in zip(tick.sample, tick.time_s, strict=True):
            ticks.setdefault(int(sample), []).append(float(time))
        return mrp_feedback(tick)

    plan(samples=2000, duration_s=5.0).run(control=control, threads=1, page=False)
    dispersed = {sample: times for sample, times in ticks.items() if sample > 0}
    each = [len(times) // (3 if sample < 8 else 1) for sample, times in dispersed.items()]
    assert len(dispersed) == 1999 and set(each) == {each[-1]} and each[-1] >= 50
    assert all(times == pytest.approx(np.arange(len(times)) % each[-1] * 0.1) for sample, times in dispersed.items() if sample > 7)
    assert all(np.bincount(np.rint(np.array(dispersed[sample]) * 10).astype(int)).tolist() == [3] * each[-1] for sample in range(1, 8))
    assert np.median(sizes) >= 24


def test_a_law_is_told_what_the_sensors_deliver() -> None:
    """Law: the measurements of a tick are those of the telemetry, the last of each sensor, with their age; NaN before the first. A loop without sensors has none."""
    tables = tomllib.loads((REPOSITORY / "benches" / "peers" / "basilisk_attitude.toml").read_text())
    tables["campaign"] |= {"duration_s": 10.0, "samples": 20}
    tables["control"]["estimator"] = "mekf"
    tables["sensors"] = [
        {"name": "gyro", "kind": "rate_gyro", "angular_random_walk_rad_sqrt_s": 1e-5},
        {"name": "eye", "kind": "star_tracker", "period_s": 1.0, "latency_s": 0.2, "noise_rad": [1e-4, 1e-4, 1e-4]},
        {"name": "turns", "kind": "tachometers", "period_s": 0.5},
    ]
    (phase,) = tables["guidance"]
    phase["law"] = "python"
    del phase["stiffness_n_m"], phase["damping_n_m_s"]
    told: dict[float, dict[str, tuple[Any, float]]] = {}

    def control(tick: sd.Tick) -> Any:
        assert list(tick.measurements) == ["gyro", "eye", "turns"] and len(tick) >= 1
        for place in np.flatnonzero(tick.sample == 17):
            told[round(float(tick.time_s[place]), 9)] = {name: (one.values[place].copy(), float(one.age_s[place])) for name, one in tick.measurements.items()}
        return mrp_feedback(tick)

    times = np.arange(100) * 0.1
    series = pl.DataFrame(sd.Plan(tables).simulate(17, times=list(times), control=control))
    columns = {
        "gyro": [f"measured_rate_s_{axis}_rad_s" for axis in "xyz"],
        "eye": [f"measured_q_es_{axis}" for axis in "wxyz"],
        "turns": [f"measured_rate_{wheel}_rad_s" for wheel in ("w1", "w2", "w3")],
    }
    assert len(told) >= 100
    for name, period, latency in (("gyro", 0.1, 0.0), ("eye", 1.0, 0.2), ("turns", 0.5, 0.0)):
        last, at = None, np.nan
        for time, row in zip(times, series.select(columns[name]).rows(), strict=True):
            if row[0] is not None and not np.isnan(row[0]):
                last, at = row, time - latency
            values, age = told[round(float(time), 9)][name]
            if last is None:
                assert np.isnan(values).all() and np.isnan(age), (name, time)
                continue
            assert tuple(values[: len(last)]) == last, (name, time)
            assert age == pytest.approx(time - at, abs=1e-9) and age < period + latency + 1e-9, (name, time)
        assert last is not None

    nothing: list[int] = []

    def blind(tick: sd.Tick) -> Any:
        nothing.append(len(tick.measurements))
        return mrp_feedback(tick)

    plan(samples=8, duration_s=1.0).run(control=blind, page=False)
    assert set(nothing) == {0}


def test_what_a_law_raises_is_raised_here() -> None:
    """Law: an exception of the law ends the campaign and is what the caller gets; so is an answer of another shape; one that is no number ends that run alone."""

    def broken(tick: sd.Tick) -> Any:
        raise ValueError("at once")

    with pytest.raises(ValueError, match="at once"):
        plan().run(control=broken)
    with pytest.raises(ValueError, match=r"shape \(\d+, 2\); it must be \(\d+, 3\)"):
        plan().run(control=lambda tick: np.zeros((len(tick), 2)))

    def lost(tick: sd.Tick) -> Any:
        return np.where((tick.sample == 7)[:, None] & (tick.time_s > 3.0)[:, None], np.nan, mrp_feedback(tick))

    rows = pl.DataFrame(plan().run(control=lost, page=False).rows)
    assert rows.filter(pl.col("failure") > 0)["sample_id"].to_list() == [7]


def test_a_law_that_is_not_there_is_missed(tmp_path: Path) -> None:
    """Law: without `control=` nothing is flown, here and on the command line, and the message says what to do; a law that no phase names is refused."""
    results = plan(samples=8).run(control=mrp_feedback, out=tmp_path / "result")
    lost = sd.open(results.path)
    for flies in (lambda: plan().run(), lambda: plan().check(), lambda: plan().simulate(3), lambda: lost.series(3)):
        with pytest.raises(sd.SpindriftError, match=r"plan\.run\(control=\.\.\.\)"):
            flies()
    said = command("campaign", str(results.path / "plan.toml"), "--out", str(tmp_path / "other"))
    assert said.returncode == 2 and "plan.run(control=...)" in said.stderr
    said = command("verify", str(results.path), "--fraction", "0")
    assert said.returncode == 2 and "plan.run(control=...)" in said.stderr
    assert command("compare", str(results.path), str(results.path)).returncode == 0
    assert "runs of" in str(plan().check(control=mrp_feedback))
    with pytest.raises(sd.SpindriftError, match='no phase has law = "python"'):
        plan("mrp_feedback").run(control=mrp_feedback)

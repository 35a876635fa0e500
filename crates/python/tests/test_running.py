"""Running: Ctrl-C, progress, other threads of the program."""

from __future__ import annotations

import multiprocessing
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import polars as pl
import pytest
from conftest import START, unbroken

import spindrift as sd

# Long enough to be stopped: small parts, each some tenths of a second.
SETTINGS = {"campaign.duration_s": 5000.0, "observe.points": 2001}
PROGRAM = """
import sys, spindrift as sd
plan = sd.load(sys.argv[1]).set({"campaign.duration_s": 5000.0, "observe.points": 2001})
try:
    plan.run(samples=int(sys.argv[3]), out=sys.argv[2], threads=1, page=False)
except KeyboardInterrupt as stopped:
    print(stopped, flush=True)
    sys.exit(42)
"""


def started(out: Path, words: list[str]) -> subprocess.Popen[str]:
    """A process that runs into `out`, once its first two parts are there."""
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=unbroken())
    limit = time.monotonic() + 120
    while len(list(out.glob("runs/part-*"))) < 2:
        assert process.poll() is None and time.monotonic() < limit, "it has ended, or does nothing"
        time.sleep(0.02)
    return process


def test_ctrl_c_stops_and_the_same_call_continues(tmp_path: Path) -> None:
    """Law: as on the command line: what is done stays, the message says how much, and the rows are in the end those of an undisturbed run."""
    samples, out = 20_000, tmp_path / "stopped"
    process = started(out, [sys.executable, "-c", PROGRAM, str(START), str(out), str(samples)])
    process.send_signal(signal.SIGINT)
    asked = time.monotonic()
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 42, said
    assert time.monotonic() - asked < 30
    assert f"of {samples} samples are done and safe. The same call continues." in said, said
    with pytest.raises(sd.SpindriftError, match="not finished"):
        sd.open(out)
    parts = pl.concat([pl.read_parquet(file) for file in sorted((out / "runs").iterdir())])
    assert 0 < parts.height < samples
    # as many samples as are done, so that the test is short: rows do not depend on the number of samples
    plan = sd.load(START).set(SETTINGS)
    rows = pl.DataFrame(plan.run(samples=parts["sample_id"].max() + 1, page=False).rows)  # type: ignore[operator, arg-type]
    assert rows.filter(pl.col("sample_id").is_in(parts["sample_id"].implode())).equals(parts)


def test_a_stopped_run_is_continued(tmp_path: Path) -> None:
    """Law: a run that was stopped from another thread is continued to the rows of an undisturbed one."""
    plan, out = sd.load(START), tmp_path / "x"
    job = plan._plan.run(20_000, str(out), 1, False, False, False)
    while job.progress()[1] == 0:
        assert not job.wait(0.001)
    job.stop()
    assert job.wait(60)
    left = job.ended()
    assert left is not None and left[0] == 20_000 and 0 < left[1] < 20_000
    results = plan.run(samples=20_000, out=out)
    assert pl.DataFrame(results.rows).equals(pl.DataFrame(plan.run(samples=20_000).rows))


def test_other_threads_of_python_go_on() -> None:
    """Law: Python's lock is not held while runs are made."""
    counted, stop = [0], threading.Event()

    def count() -> None:
        while not stop.wait(0.005):
            counted[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    start = time.monotonic()
    sd.load(START).run(samples=20_000, page=False)
    took = time.monotonic() - start
    stop.set()
    thread.join()
    assert counted[0] > 10 * min(took, 1.0), (counted, took)


def test_campaigns_run_side_by_side() -> None:
    """Law: two campaigns in two threads are those of one after the other."""
    plan, found = sd.load(START), {}

    def run(seed: int) -> None:
        found[seed] = pl.DataFrame(plan.set({"campaign.seed": seed}).run(samples=500, page=False).rows)

    threads = [threading.Thread(target=run, args=(seed,)) for seed in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for seed in (1, 2):
        assert found[seed].equals(pl.DataFrame(plan.set({"campaign.seed": seed}).run(samples=500).rows))
    assert not found[1].equals(found[2])


@pytest.mark.parametrize("has_tqdm", [True, False])
def test_progress_is_shown(has_tqdm: bool, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """Law: by tqdm where it is installed, else by a line; and only where it is asked for."""
    if not has_tqdm:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    sd.load(START).run(samples=5000, page=False, progress=True)
    shown = capsys.readouterr().err
    assert ("run/s" in shown and "5000/5000" in shown) if has_tqdm else "start: 5000 of 5000 runs" in shown, shown
    sd.load(START).run(samples=500, page=False)
    assert capsys.readouterr().err == ""


def a_value(seed: int) -> float:
    """A number of a campaign with this seed."""
    found = sd.load(START).set({"campaign.seed": seed}).run(samples=100, page=False).rows["spin_axis_angle_max_rad"][5]
    assert isinstance(found, float)
    return found


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes_run_campaigns(method: str) -> None:
    """Law: processes that Python starts run campaigns, also where the one that was forked has run some: none waits for a thread that is not there."""
    here = [a_value(seed) for seed in range(3)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map_async(a_value, range(3)).get(timeout=120) == here


def test_two_ctrl_c_end_at_once(tmp_path: Path) -> None:
    """Law: the second one gives up the parts under way; what is committed stays."""
    out = tmp_path / "x"
    process = started(out, [sys.executable, "-c", PROGRAM, str(START), str(out), "1000000"])
    process.send_signal(signal.SIGINT)
    time.sleep(0.1)
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    asked = time.monotonic()
    said, _ = process.communicate(timeout=60)
    # where the first one alone was enough, the second one meets a process that is about to leave: Python ends by the signal then
    assert process.returncode in (42, -signal.SIGINT) and "stopped" in said and time.monotonic() - asked < 20, said
    assert len(list(out.glob("runs/part-*"))) >= 2


def test_ctrl_c_stops_the_command(tmp_path: Path) -> None:
    """Law: the command of the package ends as the program does: 130, what is done is safe."""
    out = tmp_path / "x"
    sets = [word for key, value in SETTINGS.items() for word in ("--set", f"{key}={value}")]
    words = ["campaign", str(START), "--out", str(out), "--samples", "1000000", "--threads", "1", *sets]
    process = started(out, [sys.executable, "-m", "spindrift", *words])
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=60)
    assert process.returncode == 130 and "stopped by SIGINT" in said and "The same command continues." in said, said

"""What tests share: the file that `spindrift new` writes, and one finished result of it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import spindrift as sd

REPOSITORY = Path(__file__).parents[3]
START = REPOSITORY / "assets" / "start.toml"


def unbroken() -> dict[str, str]:
    """An environment in which no message is wrapped: without the width of a terminal, which the module `readline` hands on to processes."""
    return {key: value for key, value in os.environ.items() if key != "COLUMNS"}


def command(*words: str, cwd: Path | None = None, as_wide: bool = False) -> subprocess.CompletedProcess[str]:
    """The command line of the package, unbroken, or with the width of a terminal that this process knows."""
    line = [sys.executable, "-m", "spindrift", *words]
    return subprocess.run(line, capture_output=True, text=True, cwd=cwd, env=None if as_wide else unbroken(), timeout=300)


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> sd.Results:
    """300 runs, some audited, with quantiles over time."""
    plan = sd.load(START).set({"audit.fraction": 0.05, "bands.points": 5})
    return plan.run(samples=300, out=tmp_path_factory.mktemp("shared") / "result")

"""What tests share: the file that `spindrift new` writes, and one finished result of it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import spindrift as sd

REPOSITORY = Path(__file__).parents[2]
START = REPOSITORY / "assets" / "start.toml"


def command(*words: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """The command line of the package."""
    return subprocess.run([sys.executable, "-m", "spindrift", *words], capture_output=True, text=True, cwd=cwd, timeout=300)


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> sd.Results:
    """300 runs, some audited, with quantiles over time."""
    plan = sd.load(START).set({"audit.fraction": 0.05, "bands.points": 5})
    return plan.run(samples=300, out=tmp_path_factory.mktemp("shared") / "result")

"""The recipe of docs/cluster.md for Dask, with a local cluster: the bytes of one process."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import REPOSITORY, START, command


def recipe(first: str) -> str:
    """The block of the document that begins with this line."""
    text = (REPOSITORY / "docs" / "cluster.md").read_text(encoding="utf-8")
    (found,) = (block for block in re.findall(r"(?s)```text\n(.*?)```", text) if block.startswith(first))
    assert isinstance(found, str)
    return found


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below a folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_the_recipe_of_dask_makes_the_bytes_of_one_process(tmp_path: Path) -> None:
    """Law: the recipe as it stands, but for scheduler and paths."""
    pytest.importorskip("distributed")
    text = recipe("from dask.distributed")
    for written, here in [
        ('Client("scheduler:8786")', "Client(processes=False, dashboard_address=None)"),
        ("/data/spin_sweep", "shared"),
    ]:
        assert written in text
        text = text.replace(written, here)
    (tmp_path / "spin_sweep.toml").write_text(START.read_text())
    done = subprocess.run([sys.executable, "-c", text], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    one = command("campaign", "spin_sweep.toml", "--out", "one", cwd=tmp_path)
    assert one.returncode == 0, one.stderr
    assert contents(tmp_path / "shared") == contents(tmp_path / "one")

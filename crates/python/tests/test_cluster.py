"""The recipes of docs/cluster.md for Ray and Dask, with a local cluster: the bytes of one process."""

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


RECIPES = {
    "distributed": ("from dask.distributed", [('Client("scheduler:8786")', "Client(processes=False, dashboard_address=None)")]),
    "ray": ("import ray", [("num_cpus=16", "num_cpus=1"), ('"--threads", "16"', '"--threads", "1"')]),
}


@pytest.mark.parametrize("package", RECIPES)
def test_a_recipe_makes_the_bytes_of_one_process(package: str, tmp_path: Path) -> None:
    """Law: the recipe as it stands, but for scheduler, cores and paths."""
    pytest.importorskip(package)
    first, changes = RECIPES[package]
    text = recipe(first)
    for written, here in [*changes, ("/data/spin_sweep", str(tmp_path / "shared"))]:
        assert written in text
        text = text.replace(written, here)
    (tmp_path / "spin_sweep.toml").write_text(START.read_text())
    done = subprocess.run([sys.executable, "-c", text], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    one = command("campaign", "spin_sweep.toml", "--out", "one", cwd=tmp_path)
    assert one.returncode == 0, one.stderr
    assert contents(tmp_path / "shared") == contents(tmp_path / "one")

"""The examples of README and docs/python.md run, one after the other, and have the types that the stubs say."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import REPOSITORY, START


def examples(document: str) -> list[str]:
    """The Python blocks of a document; of the README those of its section on Python."""
    text = (REPOSITORY / document).read_text(encoding="utf-8")
    if document == "README.md":
        text = text.split("\n## In Python\n")[1].split("\n## ")[0]
    return re.findall(r"(?s)```python\n(.*?)```", text)


@pytest.mark.parametrize("document", ["README.md", "docs/python.md"])
def test_the_examples_run(document: str, tmp_path: Path) -> None:
    """Law: as one program in an empty folder with the file that `spindrift new` writes; mypy finds nothing wrong with it."""
    found = examples(document)
    assert found
    (tmp_path / "my_sweep.toml").write_text(START.read_text())
    program = tmp_path / "examples.py"
    program.write_text("\n".join(found))
    done = subprocess.run([sys.executable, program.name], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", program.name], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert checked.returncode == 0, checked.stdout

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


DOCUMENTS = ["README.md", "docs/python.md"]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_the_examples_run(document: str, tmp_path: Path) -> None:
    """Law: as one program in an empty folder with the file that `spindrift new` writes."""
    found = examples(document)
    assert found
    (tmp_path / "my_sweep.toml").write_text(START.read_text())
    done = subprocess.run(
        [sys.executable, "-c", "\n".join(found)], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr


def test_the_examples_have_the_types_of_the_stubs(tmp_path: Path) -> None:
    """Law: mypy finds nothing wrong with them, and finds what is wrong."""
    programs = {f"example_{index}.py": "\n".join(examples(document)) for index, document in enumerate(DOCUMENTS)}
    programs["wrong.py"] = 'import spindrift as sd\nsd.load("x.toml").run(samples="many").row\n'
    for name, text in programs.items():
        (tmp_path / name).write_text(text)
    words = [sys.executable, "-m", "mypy", "--strict", *programs]
    checked = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=300)
    lines = [line for line in checked.stdout.splitlines() if ": error: " in line]
    assert len(lines) == 2 and all(line.startswith("wrong.py:2: ") for line in lines), checked.stdout

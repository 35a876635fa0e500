"""Finished results: rows, and what they say."""

from __future__ import annotations

import functools
import html
import json
import os
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from . import _native
from ._law import Control
from ._shown import Shown


class Report:
    """The report page of a result. A notebook shows it inline; `save` writes it as a file that opens from disk."""

    html: str

    def __init__(self, text: str) -> None:
        self.html = text

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes the page to `path`."""
        Path(path).write_text(self.html, encoding="utf-8")
        return Path(path)

    def _repr_html_(self) -> str:
        # a document of its own, so that its styles stay its own
        return f'<iframe srcdoc="{html.escape(self.html)}" style="width:100%;height:900px;border:0"></iframe>'

    def __repr__(self) -> str:
        return f"<spindrift.Report: {len(self.html)} characters>"


class Comparison(Shown):
    """Two results compared: `shifts` has the shift of every statistic; the text is what `spindrift compare` prints."""

    shifts: _native.Table

    def __init__(self, text: str, shifts: _native.Table) -> None:
        super().__init__(text)
        self.shifts = shifts


class Results:
    """A finished result in a folder, whose checksums were compared.

    Tables are read when they are first asked for, and kept. Whenever files are read their checksums are compared again, and a result that was replaced or
    extended in the meantime is refused. No lock is kept: the campaign can be extended while this is there.
    """

    _results: _native.Results
    _temporary: TemporaryDirectory[str] | None
    _control: Control | None

    @classmethod
    def _open(
        cls, folder: str | os.PathLike[str], temporary: TemporaryDirectory[str] | None = None, control: Control | None = None
    ) -> Results:
        made = cls.__new__(cls)
        made._results = _native.Results.open(os.fspath(folder))
        made._temporary, made._control = temporary, control
        return made

    @property
    def path(self) -> Path:
        """The folder."""
        return Path(self._results.root())

    @functools.cached_property
    def summary(self) -> dict[str, Any]:
        """What `summary.json` says."""
        found: dict[str, Any] = json.loads(self._results.summary())
        return found

    @property
    def requirements(self) -> list[dict[str, Any]]:
        """The requirements with their verdicts (PASS, FAIL, UNDECIDED), fractions and intervals, as in `summary.json`."""
        found: list[dict[str, Any]] = self.summary["requirements"].get("list", [])
        return found

    @functools.cached_property
    def plan(self) -> str:
        """The plan that was run, as TOML."""
        return self._results.plan()

    @functools.cached_property
    def rows(self) -> _native.Table:
        """One row a run: sample, status, what was drawn, what was observed (docs/columns.md)."""
        return self._results.rows()

    @functools.cached_property
    def statistics(self) -> _native.Table:
        """Statistics of every observable, with intervals."""
        return self._results.statistics()

    @functools.cached_property
    def sensitivity(self) -> _native.Table:
        """What drives the main observables."""
        return self._results.sensitivity()

    @functools.cached_property
    def bands(self) -> _native.Table | None:
        """Quantiles over time; `None` where the campaign has no `[bands]`."""
        return self._results.bands()

    def series(self, sample: int) -> _native.Table:
        """The run of a sample again over time: bit for bit that of its row."""
        return self._results.series(sample, self._control)

    def report(self) -> Report:
        """The report page."""
        return Report(self._results.page(self._control))

    def __repr__(self) -> str:
        return f"{self.summary['campaign']}: {self.summary['samples']} samples\n{self._results.verdicts()}".rstrip()

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(repr(self))}</pre>"


def open(folder: str | os.PathLike[str], control: Control | None = None) -> Results:
    """The finished result in `folder`, after its checksums were compared. `control`: the law that flew it, where that is a function of Python."""
    return Results._open(folder, control=control)


def compare(first: Results | str | os.PathLike[str], second: Results | str | os.PathLike[str]) -> Comparison:
    """Compares two results, sample by sample where both drew the same ones."""
    folders = [one._results.root() if isinstance(one, Results) else one for one in (first, second)]
    return Comparison(*_native.compare(os.fspath(folders[0]), os.fspath(folders[1])))

"""Campaigns: what is to be run."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Mapping
from typing import Any

from . import _native
from ._law import Control
from ._results import Results
from ._running import finish, say
from ._shown import Shown


class Check(Shown):
    """What a campaign would run, in words: as `spindrift check` prints it."""


class Plan:
    """A campaign: a file, or a dict with the same tables and keys, and what is changed of it.

    A plan does not change: `set` returns another one. Its file is read whenever the plan is used.

    >>> plan = sd.Plan({
    ...     "campaign": {"name": "spin", "samples": 1000, "seed": 1, "duration_s": 60.0},
    ...     "body": {...},
    ...     "disperse": [{"parameter": "initial.angular_velocity_rad_s.z", "distribution": "normal", "std": "1 deg/s"}],
    ... })
    """

    _plan: _native.Plan

    def __init__(self, tables: Mapping[str, Any]) -> None:
        """The campaign file that `tables` are: dicts, lists, numbers, texts, truth values, and what NumPy makes of them."""
        self._plan = _native.Plan.from_dict(dict(tables))

    @classmethod
    def _of(cls, plan: _native.Plan) -> Plan:
        made = cls.__new__(cls)
        made._plan = plan
        return made

    def set(self, values: Mapping[str, Any]) -> Plan:
        """The same campaign with other values of these keys, named as in error messages: `{"wheels.w1.rate_rad_s": "20 rpm"}`."""
        return Plan._of(self._plan.set(dict(values)))

    @property
    def name(self) -> str:
        """The name of the campaign."""
        return self._plan.facts()[0]

    @property
    def samples(self) -> int:
        """The number of samples; sample 0 is the nominal scene."""
        return self._plan.facts()[1]

    @property
    def duration_s(self) -> float:
        """The end of the runs, s."""
        return self._plan.facts()[2]

    @property
    def text(self) -> str:
        """The resolved plan as TOML, with all defaults: a campaign file of the same rows."""
        return self._plan.text()

    def check(self, samples: int | None = None, control: Control | None = None) -> Check:
        """What would run, how long that takes, and what is implausible. Shown in notebooks."""
        return Check(self._plan.check(samples, control))

    def sample(self, samples: int | None = None) -> _native.Table:
        """The dispersed parameters and mass properties of the first `samples` samples, drawn as a campaign of so many draws them, without runs."""
        return self._plan.sample(samples)

    def simulate(
        self, sample: int = 0, times: Iterable[float] | None = None, control: Control | None = None
    ) -> _native.Table:
        """One sample over time, exactly as the campaign runs it; at `times` (s), else at the points of the campaign."""
        table, notes = self._plan.simulate(sample, None if times is None else [float(time) for time in times], control)
        say(notes)
        return table

    def run(
        self,
        samples: int | None = None,
        out: str | os.PathLike[str] | None = None,
        threads: int = 0,
        progress: bool = False,
        overwrite: bool = False,
        page: bool = True,
        yes: bool = False,
        control: Control | None = None,
    ) -> Results:
        """Runs the samples that have no rows yet, and returns the finished result.

        samples: how many, whatever the file says; a larger number extends a result that is there.
        out: the folder of the result. Without it the result is in a temporary folder, which goes with the object.
        threads: how many; 0: one per core. Rows do not depend on it.
        progress: a bar on standard error, tqdm's where that is installed.
        overwrite: replaces an existing result, which stays as it is until the new one is complete.
        page: with report.html; `Results.report` makes it later where it is not there.
        yes: also where it takes more than a day of CPU time, or half of the free disk.
        control: the law of attitude of the phases that have `law = "python"`: a function from a `Tick` to torques, asked once per control tick for all runs
        that are at it. What it raises ends the campaign, and is raised here.

        Ctrl-C stops as on the command line: parts under way may end within 5 s, a second one gives them up. What is committed stays, and the
        same call with the same `out` continues.
        """
        temporary, name = None, self.name
        if out is None:
            temporary = tempfile.TemporaryDirectory(prefix="spindrift-")
            out = os.path.join(temporary.name, "result")
        folder = os.fspath(out)
        job = self._plan.run(samples, folder, threads, overwrite, page, yes, control)
        finish(job, name, progress, kept=temporary is None)
        return Results._open(folder, temporary, control)

    def __repr__(self) -> str:
        name, samples, duration = self._plan.facts()
        return f"<spindrift.Plan {name}: {samples} runs of {duration:g} s>"


def load(path: str | os.PathLike[str]) -> Plan:
    """The campaign file `path`; a bare name, with or without `.toml`, is also looked up in `campaigns/`."""
    return Plan._of(_native.Plan.from_file(os.fspath(path)))

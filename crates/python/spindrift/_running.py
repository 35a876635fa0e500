"""Runs a campaign to its end, while the user can watch it, and stop it."""

from __future__ import annotations

import logging
import sys
from collections.abc import Iterable
from types import TracebackType

from . import _native

# How long parts under way may take to end after Ctrl-C, and then to be given up, s: as on the command line.
_GRACE = 5.0
_LAST = 1.5
# How often the user is listened to, s.
_LISTEN = 0.05

_log = logging.getLogger("spindrift")


def say(notes: Iterable[str]) -> None:
    """Logs what a person should know, at the level of warnings of the logger `spindrift`."""
    for note in notes:
        _log.warning(note)


class _Bar:
    """Progress on standard error: tqdm's bar where that is installed, else a line."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._shown = 0
        try:
            from tqdm.auto import tqdm
        except ImportError:
            self._bar = None
        else:
            self._bar = tqdm(desc=name, unit="run")

    def __enter__(self) -> _Bar:
        return self

    def show(self, samples: int, done: int) -> None:
        if self._bar is not None:
            self._bar.total = samples
            self._bar.update(done - self._shown)
        elif done > self._shown:
            sys.stderr.write(f"\r{self._name}: {done} of {samples} runs")
            sys.stderr.flush()
        self._shown = done

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._bar is not None:
            self._bar.close()
        elif self._shown:
            sys.stderr.write("\n")


def finish(job: _native.Job, name: str, progress: bool, kept: bool) -> None:
    """Waits for the end of `job`. Ctrl-C stops it: parts under way may end, and what is committed stays where the result is `kept`."""
    try:
        if progress:
            with _Bar(name) as bar:
                while not job.wait(_LISTEN):
                    bar.show(*job.progress())
                bar.show(*job.progress())
        else:
            while not job.wait(_LISTEN):
                pass
    except KeyboardInterrupt:
        raise KeyboardInterrupt(_stopped(job, name, kept)) from None
    finally:
        say(job.notes())
    job.ended()


def _stopped(job: _native.Job, name: str, kept: bool) -> str:
    """Stops `job`, a second Ctrl-C at once; what is left, in words."""
    job.stop()
    try:
        if not _waited(job, _GRACE):
            job.abandon()
            if not _waited(job, _LAST):
                return f"{name}: stopped; a run under way did not end in time and is left out; what is committed stays"
    except KeyboardInterrupt:
        job.abandon()
        _waited(job, _LAST)
    left = job.ended()
    if left is None:
        return f"{name}: all runs are done" + (" and safe." if kept else ".")
    samples, rest = left
    done = f"{name}: stopped; {samples - rest} of {samples} samples are done"
    return f"{done} and safe. The same call continues." if kept else f"{done}, and nothing is kept without out=."


def _waited(job: _native.Job, seconds: float) -> bool:
    """Waits for the end of `job`, in moments in which Ctrl-C is noticed."""
    for _ in range(int(seconds / _LISTEN)):
        if job.wait(_LISTEN):
            return True
    return False

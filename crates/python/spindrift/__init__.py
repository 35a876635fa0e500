"""Monte Carlo analysis of spacecraft attitude dynamics, with a measured error for every run.

>>> import spindrift as sd
>>> plan = sd.load("my_sweep.toml").set({"wheels.w1.rate_rad_s": "1500 rpm"})
>>> results = plan.run(samples=4000, out="results/x")
>>> results.requirements
>>> results.rows          # for polars, pyarrow, pandas, DuckDB: pl.DataFrame(results.rows)

Guide: docs/python.md. Errors are `SpindriftError`, with all lines that the command line prints.
"""

from ._command import main
from ._law import Control, Tick
from ._native import SpindriftError, Table, __version__
from ._native import columns as _columns
from ._plan import Check, Plan, load
from ._results import Comparison, Report, Results, compare, open

__all__ = [
    "Check",
    "Comparison",
    "Control",
    "Plan",
    "Report",
    "Results",
    "SpindriftError",
    "Table",
    "Tick",
    "__version__",
    "columns",
    "compare",
    "load",
    "main",
    "open",
]


def columns() -> Table:
    """Every column that a row can have: group, name, unit, meaning, and in which scenes there are those."""
    return _columns()

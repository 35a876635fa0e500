"""Finished results: what their rows say, where they are, what stays true when they change."""

from __future__ import annotations

import gc
import json
from pathlib import Path

import polars as pl
import pytest
from conftest import START, command

import spindrift as sd


def test_tables_are_the_files(results: sd.Results) -> None:
    """Law: every table is the file of its name, value by value."""
    for table, file in [
        (results.statistics, "statistics.parquet"),
        (results.sensitivity, "sensitivity.parquet"),
        (results.bands, "bands.parquet"),
    ]:
        assert table is not None
        expected = pl.read_parquet(results.path / file)
        assert pl.DataFrame(table).equals(expected) and expected.height > 0, file
    assert results.rows is results.rows, "it is read once"
    assert sd.load(START).set({"bands.points": 0}).run(samples=20).bands is None


def test_verdicts_are_those_of_the_summary(results: sd.Results) -> None:
    written = json.loads((results.path / "summary.json").read_text())
    assert results.summary == written
    (requirement,) = results.requirements
    assert requirement["verdict"] == "PASS" and requirement["observable"] == "spin_axis_angle_max_rad"
    assert repr(results).startswith("start: 300 samples") and "1 PASS -> " in repr(results)
    assert "<pre>start" in results._repr_html_()
    assert 'name = "start"' in results.plan and results.plan == (results.path / "plan.toml").read_text()


def test_the_report_is_the_page(results: sd.Results, tmp_path: Path) -> None:
    """Law: the page of the file; a notebook shows all of it in a frame; where there is none it is made, the same bytes."""
    report = results.report()
    assert report.html == (results.path / "report.html").read_text(encoding="utf-8")
    shown = report._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "&lt;html" in shown and "<script" not in shown
    assert report.save(tmp_path / "page.html").read_text(encoding="utf-8") == report.html
    plan = sd.load(START)
    with_page, without = plan.run(samples=40, out=tmp_path / "a"), plan.run(samples=40, out=tmp_path / "b", page=False)
    assert not (tmp_path / "b" / "report.html").exists()
    assert without.report().html == with_page.report().html
    assert len(without.rows) == 40, "the result is the same, with a page"


def test_without_out_nothing_stays() -> None:
    """Law: a result in memory is a whole one, and goes with its object."""
    results = sd.load(START).run(samples=30)
    folder = results.path
    assert folder.is_dir() and len(results.rows) == 30 and len(results.series(3)) == 121
    del results
    gc.collect()
    assert not folder.exists()


def test_a_result_is_opened_again(results: sd.Results) -> None:
    again = sd.open(results.path)
    assert pl.DataFrame(again.rows).equals(pl.DataFrame(results.rows))
    assert again.summary == results.summary


def test_a_result_grows_while_it_is_open(tmp_path: Path) -> None:
    """Law: more samples extend what is there; the same call finds all of it; and what was opened before says so, where it was not read yet."""
    plan, out = sd.load(START), tmp_path / "x"
    first = plan.run(samples=100, out=out)
    rows = pl.DataFrame(first.rows)
    more = plan.run(samples=150, out=out)
    assert pl.DataFrame(more.rows).head(100).equals(rows) and len(more.rows) == 150
    assert pl.DataFrame(plan.run(samples=150, out=out).rows).equals(pl.DataFrame(more.rows))
    with pytest.raises(sd.SpindriftError, match="open it again"):
        first.statistics  # noqa: B018
    with pytest.raises(sd.SpindriftError, match="overwrite"):
        plan.set({"campaign.seed": 5}).run(samples=100, out=out)
    other = plan.set({"campaign.seed": 5}).run(samples=100, out=out, overwrite=True)
    assert not pl.DataFrame(other.rows).equals(rows)


def test_a_damaged_result_is_refused(tmp_path: Path) -> None:
    results = sd.load(START).run(samples=50, out=tmp_path / "x")
    (part,) = (tmp_path / "x" / "runs").iterdir()
    content = bytearray(part.read_bytes())
    content[len(content) // 2] ^= 1
    part.write_bytes(content)
    for call in (lambda: results.rows, lambda: sd.open(tmp_path / "x")):
        with pytest.raises(sd.SpindriftError, match="part-|runs/"):
            call()


def test_results_are_compared(results: sd.Results, tmp_path: Path) -> None:
    """Law: a result and itself have no shift; another has, and the text is that of the command line."""
    same = sd.compare(results, results.path)
    for name in ("mean_shift", "largest_shift", "differing_pairs"):
        assert {value for value in same.shifts[name] if value is not None} == {0.0}, name
    other = sd.load(START).set({"wheels.w1.rate_rad_s": "1500 rpm"}).run(samples=300, out=tmp_path / "other")
    found = sd.compare(results, other)
    printed = command("compare", str(results.path), str(other.path), as_wide=True)
    assert str(found) == printed.stdout and "rate_rad_s" in str(found)
    assert max(value or 0.0 for value in found.shifts["largest_shift"]) > 0.1
    assert found._repr_html_().startswith("<pre>")


def test_the_command_line_comes_with_the_package(tmp_path: Path) -> None:
    """Law: it prints and exits as the program does."""
    assert command("--version").stdout == f"spindrift {sd.__version__}\n"
    assert command("new", "my_sweep.toml", cwd=tmp_path).returncode == 0
    expected = "#:schema spindrift.schema.json\n" + START.read_text().replace('"start"', '"my_sweep"')
    assert (tmp_path / "my_sweep.toml").read_text() == expected
    done = command("campaign", "my_sweep.toml", "--samples", "200", cwd=tmp_path)
    assert done.returncode == 0 and "PASS" in done.stdout, done.stderr
    failed = command("campaign", "my_sweep.toml", "--samples", "200", "--set", "require[0].at_most=0.001 deg", "--out", "f", cwd=tmp_path)
    assert failed.returncode == 3 and "FAIL" in failed.stdout
    assert command("no_such_command").returncode == 2
    assert len(sd.open(tmp_path / "results" / "my_sweep").rows) == 200

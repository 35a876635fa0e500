"""Results at s3:// addresses: the wheel has a client for them. `.ci/cloud` tests it against a server, whose address is in SPINDRIFT_S3."""

from __future__ import annotations

import os
import urllib.request
from pathlib import Path

import polars as pl
import pytest

import spindrift as sd
from conftest import START, command

VARIABLES = ("AWS_ENDPOINT_URL", "AWS_ENDPOINT_URL_S3", "AWS_ENDPOINT", "AWS_ALLOW_HTTP", "AWS_SESSION_TOKEN")


@pytest.fixture
def credentials(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """An environment with credentials of no worth, and nothing else that is about stores."""
    for variable in VARIABLES:
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv("AWS_ACCESS_KEY_ID", "tests")
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "a-secret-of-tests")
    return monkeypatch


def test_the_client_is_there_and_says_what_is_wrong(credentials: pytest.MonkeyPatch, tmp_path: Path) -> None:
    credentials.setenv("AWS_ENDPOINT_URL", "http://127.0.0.1:1")
    with pytest.raises(sd.SpindriftError, match="AWS_ALLOW_HTTP=true allows that") as said:
        sd.load(START).run(samples=2, out="s3://bucket/x")
    assert "a-secret-of-tests" not in str(said.value)
    by_command = command("campaign", str(START), "--samples", "2", "--out", "s3://bucket/x", cwd=tmp_path)
    assert by_command.returncode == 4 and "s3://bucket/x: AWS_ENDPOINT_URL is not encrypted" in by_command.stderr


@pytest.mark.skipif("SPINDRIFT_S3" not in os.environ, reason="needs an S3 server: .ci/cloud")
def test_rows_in_a_store_are_those_of_a_folder(credentials: pytest.MonkeyPatch, tmp_path: Path) -> None:
    server = f"http://{os.environ['SPINDRIFT_S3']}"
    # any signature is as good as another to a server of tests
    signed = "AWS4-HMAC-SHA256 Credential=tests/20260101/us-east-1/s3/aws4_request, SignedHeaders=host, Signature=0"
    made = urllib.request.Request(f"{server}/python", method="PUT", headers={"Authorization": signed})
    urllib.request.urlopen(made, timeout=60).close()
    credentials.setenv("AWS_ENDPOINT_URL", server)
    credentials.setenv("AWS_ALLOW_HTTP", "true")

    address, plan = "s3://python/x", sd.load(START)
    there, here = plan.run(samples=40, out=address), plan.run(samples=40, out=tmp_path / "x")
    for results in (there, sd.open(address)):
        assert pl.DataFrame(results.rows).equals(pl.DataFrame(here.rows))
    verified = command("verify", address, cwd=tmp_path)
    assert verified.returncode == 0, verified.stderr

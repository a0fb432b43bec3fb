"""The adapter around a job: what is said when it fails."""

from types import SimpleNamespace

import pytest

from bouncing_ball.pipeline.job import logged


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ValueError("one\ntwo\n  three"), "stage/fig08: one two three (details in "),
        (KeyError("ϖ"), "stage/fig08: KeyError: 'ϖ' (details in "),
    ],
)
def test_a_failure_is_one_line(tmp_path, monkeypatch, one_line, error, said):
    # An interrupted job ends at once, but the tests are not to.
    monkeypatch.setattr("signal.signal", lambda *_: None)
    log = tmp_path / "logs" / "job.log"
    job = SimpleNamespace(rule="stage", wildcards=["fig08"], log=[str(log)])
    with pytest.raises(SystemExit) as exit_, logged(job):
        raise error
    one_line(exit_, f"{said}{log})")
    assert "Traceback" in log.read_text(encoding="utf-8")

"""The share of a run that is done."""

from bouncing_ball.pipeline.jobs import advance, begin


def test_each_job_that_ends_is_counted(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # A job by itself, without a run.
    assert advance() == "" and not list(tmp_path.iterdir())
    begin(3)
    assert [advance() for _ in range(3)] == ["1 of 3, 33 %", "2 of 3, 66 %", "3 of 3, 100 %"]
    begin(2)
    assert advance() == "1 of 2, 50 %"

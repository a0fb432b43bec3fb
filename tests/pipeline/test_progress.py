"""The share of a run that is done."""

from bouncing_ball.pipeline.progress import advance, begin


def test_each_job_that_ends_is_counted(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # A job by itself, without a run.
    assert advance() == "" and not list(tmp_path.iterdir())
    begin(4)
    found = [advance() for _ in range(4)]
    assert [text.split(", about")[0] for text in found] == [
        "1 of 4, 25 %",
        "2 of 4, 50 %",
        "3 of 4, 75 %",
        "4 of 4, 100 %",
    ]
    assert all(("left" in text) == (k < 3) for k, text in enumerate(found))
    begin(2)
    assert advance().startswith("1 of 2, 50 %")

import io

from bouncing_ball.pipeline.progress import Progress


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_bar_for_all_jobs_on_a_terminal(tmp_path):
    now, stream = [0.0], Terminal()
    (tmp_path / "other").write_text("50 5.0 0.0\n")
    told = Progress(tmp_path, "one", 100, 200, stream, lambda: now[0])
    now[0] = 10.0
    told(50)
    # Half of all is done, at 5 a second each.
    assert (
        "[###############...............] 50 %, 0.0 million orbits/s, 10 s left"
        in stream.getvalue()
    )
    now[0] = 20.0
    told(50)
    assert stream.getvalue().endswith("\r\033[K")


def test_a_job_that_was_killed_has_no_rate(tmp_path):
    now, stream = [100.0], Terminal()
    (tmp_path / "killed").write_text("50 1000.0 0.0\n")
    told = Progress(tmp_path, "one", 150, 200, stream, lambda: now[0])
    now[0] = 110.0
    told(50)
    assert "50 %, 0.0 million orbits/s, 20 s left" in stream.getvalue()


def test_lines_about_the_job_itself_elsewhere(tmp_path):
    now, stream = [0.0], io.StringIO()
    told = Progress(tmp_path, "0003-of-0020", 4_000_000, 10**9, stream, lambda: now[0])
    now[0] = 2.0
    told(1_000_000)
    assert stream.getvalue() == ""
    now[0] = 12.0
    told(1_000_000)
    now[0] = 13.0
    told(2_000_000)
    assert stream.getvalue().splitlines() == [
        "0003-of-0020: 50 %, 0.2 million orbits/s, 12 s left",
        "0003-of-0020: 100 %, 0.3 million orbits/s, 0 s left",
    ]


def test_a_bar_fits_into_a_narrow_terminal(tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    now, stream = [0.0], Terminal()
    told = Progress(tmp_path, "one", 100, 100, stream, lambda: now[0])
    now[0] = 10.0
    told(50)
    (bar,) = stream.getvalue().split("\r\033[K")[1:]
    assert bar.startswith("[###") and len(bar) < 60

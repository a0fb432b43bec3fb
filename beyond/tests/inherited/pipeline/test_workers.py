"""Scripts that share processes."""

import os
import signal
from pathlib import Path
from types import SimpleNamespace

import pytest

from bouncing_ball_beyond.inherited.pipeline import workers

NOTING = """\
import os
from pathlib import Path

Path(snakemake.output).write_text(f"{os.getpid()} {'left' in globals()}")
left = True
"""


@pytest.fixture
def noted(tmp_path, monkeypatch):
    """Run the script, to see its process and whether it finds names of another script."""
    # A process keeps the standard error that it was started with.
    monkeypatch.setattr(workers, "_idle", [])

    def run() -> str:
        job = SimpleNamespace(output=str(tmp_path / "said"))
        (tmp_path / "noting.py").write_text(NOTING, encoding="utf-8")
        assert workers.run_script(tmp_path / "noting.py", job)
        return Path(job.output).read_text(encoding="utf-8")

    yield run
    workers.end_processes()


def test_scripts_share_a_process_but_no_names(noted):
    first = noted()
    assert first == noted()
    assert first.split()[1] == "False"
    assert int(first.split()[0]) != os.getpid()


@pytest.mark.parametrize("end", ["raise SystemExit('no orbit')", "1 / 0", "no Python"])
def test_a_script_that_fails_ends_its_process(noted, tmp_path, capfd, end):
    before = noted()
    (tmp_path / "failing.py").write_text(end, encoding="utf-8")
    assert not workers.run_script(tmp_path / "failing.py", None)
    assert capfd.readouterr().err.splitlines()[-1].startswith(("no orbit", "Zero", "SyntaxError"))
    assert noted() != before


def test_a_process_that_is_killed_makes_its_job_fail(noted, tmp_path):
    process = int(noted().split()[0])
    (tmp_path / "killed.py").write_text("import os\nos.kill(os.getpid(), 9)", encoding="utf-8")
    assert not workers.run_script(tmp_path / "killed.py", None)
    with pytest.raises(ProcessLookupError):
        os.kill(process, signal.SIGTERM)

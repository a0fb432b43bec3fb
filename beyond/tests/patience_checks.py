"""What is asked of a command of any house that takes long: its lines, and its end by Ctrl-C.

``owner`` and ``name`` say where the function is that does the work of the command.
"""

import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from bouncing_ball_beyond.inherited.cli.main import main

PROGRAM = Path(sys.executable).with_name("bouncing-ball")


def says_what_makes_it_cheaper(
    command: str,
    owner: Any,
    name: str,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    quick = getattr(owner, name)

    def slow(*given):
        time.sleep(0.5)
        return quick(*given)

    monkeypatch.setattr(owner, name, slow)
    main(command.split())
    out, err = capfd.readouterr()
    assert out.startswith("status")
    assert err.count("\n") >= 2
    # How many seconds have passed depends on what else the machine does.
    line = (
        r"bouncing-ball: no answer after \d+ s yet; fewer impacts make the answer cheaper; "
        "Ctrl-C ends it"
    )
    assert all(re.fullmatch(line, each) for each in err.splitlines())
    time.sleep(0.3)
    assert capfd.readouterr().err == ""


def no_thread_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    """From here on a thread that starts is a failure."""

    def started(thread):
        pytest.fail(f"{thread} starts")

    monkeypatch.setattr(threading.Thread, "start", started)


def an_interrupt_is_one_line(
    command: str,
    owner: Any,
    name: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(owner, name, interrupted)
    with pytest.raises(SystemExit) as end:
        main(command.split())
    assert end.value.code == 130
    assert capsys.readouterr() == ("", "bouncing-ball: interrupted\n")


def ends_by_ctrl_c(command: str) -> None:
    """The command takes more than a minute, and says so before it is interrupted."""
    with subprocess.Popen(
        [PROGRAM, *command.split()], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        line = running.stderr.readline()
        running.send_signal(signal.SIGINT)
        out, err = running.communicate()
    assert line.endswith("fewer impacts make the answer cheaper; Ctrl-C ends it\n")
    assert (running.returncode, out, err) == (130, "", "bouncing-ball: interrupted\n")

"""Lines on standard error while a call takes long, and the end of a command by Ctrl-C."""

import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import bouncing_ball
from bouncing_ball.cli import balls
from bouncing_ball.cli import patience as module
from bouncing_ball.cli.main import main
from bouncing_ball.cli.patience import told_if_slow

PROGRAM = Path(sys.executable).with_name("bouncing-ball")
# A hundred thousand impacts on a contact take more than a minute.
LONG = "simulate --amplitude 1.1 --frequency-ratio 10 --restitution 0.85 --impacts 100000"


@pytest.fixture
def hasty(monkeypatch):
    monkeypatch.setattr(module, "_FIRST", 0.05)
    monkeypatch.setattr(module, "_NEXT", 0.1)


def test_a_command_that_takes_long_says_what_makes_it_cheaper(hasty, capfd, monkeypatch):
    simulate = balls.impacts_of

    def slow(*given):
        time.sleep(0.5)
        return simulate(*given)

    monkeypatch.setattr(balls, "impacts_of", slow)
    main(["simulate", "--amplitude", "1", "--restitution", "0.5"])
    out, err = capfd.readouterr()
    assert out.startswith("status")
    assert 2 <= err.count("\n") <= 5
    for line in err.splitlines():
        assert line == (
            "bouncing-ball: no answer after 0 s yet; fewer impacts make the answer cheaper; "
            "Ctrl-C ends it"
        )
    time.sleep(0.3)
    assert capfd.readouterr().err == ""


def test_without_advice_a_line_gives_the_time_alone(hasty, capfd):
    with told_if_slow(""):
        time.sleep(0.1)
    line = "bouncing-ball: no answer after 0 s yet; Ctrl-C ends it\n"
    assert capfd.readouterr().err == line


def test_a_call_of_the_library_starts_no_thread(monkeypatch):
    def started(thread):
        pytest.fail(f"{thread} starts")

    monkeypatch.setattr(threading.Thread, "start", started)
    ball = bouncing_ball.spring_damper(restitution=0.85, frequency_ratio=10.0)
    bouncing_ball.simulate(ball, amplitude=[0.9, 1.0])
    bouncing_ball.branch(ball, amplitude_max=1.1)


def test_a_command_that_fails_ends_its_lines(hasty, capfd):
    with pytest.raises(KeyError), told_if_slow("fewer balls"):
        raise KeyError
    time.sleep(0.2)
    assert capfd.readouterr().err == ""


def test_without_standard_error_an_answer_has_no_lines(hasty, capfd, monkeypatch):
    monkeypatch.setattr(sys, "stderr", None)
    with told_if_slow("fewer balls"):
        time.sleep(0.2)
    assert capfd.readouterr() == ("", "")


def test_an_interrupt_of_a_command_is_one_line(capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(balls, "impacts_of", interrupted)
    with pytest.raises(SystemExit) as end:
        main(["simulate", "--amplitude", "1", "--restitution", "0.5"])
    assert end.value.code == 130
    assert capsys.readouterr() == ("", "bouncing-ball: interrupted\n")


@pytest.mark.long
def test_a_command_that_takes_long_says_so_and_ends_by_ctrl_c():
    with subprocess.Popen(
        [PROGRAM, *LONG.split()], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        line = running.stderr.readline()
        running.send_signal(signal.SIGINT)
        out, err = running.communicate()
    assert line.endswith("fewer impacts make the answer cheaper; Ctrl-C ends it\n")
    assert (running.returncode, out, err) == (130, "", "bouncing-ball: interrupted\n")

"""Lines on standard error while a call takes long, and the end of a command by Ctrl-C."""

import sys
import time

import pytest
from patience_checks import (
    an_interrupt_is_one_line,
    ends_by_ctrl_c,
    no_thread_starts,
    says_what_makes_it_cheaper,
)

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited.cli import balls
from bouncing_ball_beyond.inherited.cli.patience import told_if_slow

# A hundred thousand impacts on a contact take more than a minute.
LONG = "simulate --amplitude 1.1 --frequency-ratio 10 --restitution 0.85 --impacts 100000"
SHORT = "simulate --amplitude 1 --restitution 0.5"


def test_a_command_that_takes_long_says_what_makes_it_cheaper(hasty, capfd, monkeypatch):
    says_what_makes_it_cheaper(SHORT, balls, "impacts_of", capfd, monkeypatch)


def test_without_advice_a_line_gives_the_time_alone(hasty, capfd):
    with told_if_slow(""):
        time.sleep(0.1)
    line = "bouncing-ball: no answer after 0 s yet; Ctrl-C ends it\n"
    assert capfd.readouterr().err == line


def test_a_call_of_the_library_starts_no_thread(monkeypatch):
    no_thread_starts(monkeypatch)
    ball = bouncing_ball_beyond.inherited.spring_damper(restitution=0.85, frequency_ratio=10.0)
    bouncing_ball_beyond.inherited.simulate(ball, amplitude=[0.9, 1.0])
    bouncing_ball_beyond.inherited.branch(ball, amplitude_max=1.1)


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
    an_interrupt_is_one_line(SHORT, balls, "impacts_of", capsys, monkeypatch)


@pytest.mark.long
def test_a_command_that_takes_long_says_so_and_ends_by_ctrl_c():
    ends_by_ctrl_c(LONG)

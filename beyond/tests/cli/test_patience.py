"""Lines on standard error while a command of beyond takes long, and its end by Ctrl-C."""

import pytest
from patience_checks import (
    an_interrupt_is_one_line,
    ends_by_ctrl_c,
    no_thread_starts,
    says_what_makes_it_cheaper,
)

import bouncing_ball_beyond
from bouncing_ball_beyond.models.dynamics import Dynamics

# A hundred thousand impacts on a contact take more than a minute.
LONG = "law-simulate --amplitude 1.1 --law tsuji --restitution 0.85 --duration 0.1 --impacts 100000"
SHORT = "law-simulate --amplitude 1 --restitution 0.5"


def test_a_command_that_takes_long_says_what_makes_it_cheaper(hasty, capfd, monkeypatch):
    says_what_makes_it_cheaper(SHORT, Dynamics, "simulate", capfd, monkeypatch)


def test_a_call_of_the_library_starts_no_thread(monkeypatch):
    no_thread_starts(monkeypatch)
    ball = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)
    bouncing_ball_beyond.motion_of(ball, amplitude=[0.9, 1.0])
    bouncing_ball_beyond.follow(bouncing_ball_beyond.orbit(ball, amplitude=1.0), to=1.1)


def test_an_interrupt_of_a_command_is_one_line(capsys, monkeypatch):
    an_interrupt_is_one_line(SHORT, Dynamics, "simulate", capsys, monkeypatch)


@pytest.mark.long
def test_a_command_that_takes_long_says_so_and_ends_by_ctrl_c():
    ends_by_ctrl_c(LONG)

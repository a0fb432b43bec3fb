"""The command as a user types it, and a design of each engine."""

import functools
import shlex
import sys

import pytest

from bouncing_ball_contacts import ENGINES, Bounce, cli, design


@pytest.fixture(scope="session")
def of_ball():
    """Return a function that gives the springs of an engine for one ball, at 0.5 ms."""
    ball = Bounce(mass="50 g", restitution=0.8, drop_height="1 m", radius="30 mm")

    @functools.cache
    def designed(name):
        return design(ball, ENGINES[name], "0.5 ms")

    return designed


@pytest.fixture
def typed(monkeypatch, capsys):
    """Return a function that runs the command and returns its exit status, output and message."""

    def run(line):
        monkeypatch.setattr(sys, "argv", ["bounce", *shlex.split(line)])
        with pytest.raises(SystemExit) as ended:
            cli.run()
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return run

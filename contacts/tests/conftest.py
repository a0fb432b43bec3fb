"""The command as a user types it."""

import shlex
import sys

import pytest

from bouncing_ball_contacts import cli


@pytest.fixture
def typed(monkeypatch, capsys):
    """Return a function that runs the command and returns its exit status, output and message."""

    def run(line):
        monkeypatch.setattr(sys, "argv", ["bounce", *shlex.split(line)])
        with pytest.raises(SystemExit) as ended:
            cli.run()
        found = capsys.readouterr()
        return ended.value.code or 0, found.out, found.err

    return run

"""What a call of the command line says, as it succeeds or fails."""

import json

import pytest

from bouncing_ball.cli.main import main


@pytest.fixture
def said(capsys):
    """The output of a call that succeeds."""

    def said(*arguments):
        main(list(arguments))
        out, err = capsys.readouterr()
        assert err == ""
        return out

    return said


@pytest.fixture
def ask(said):
    """The JSON answer of a call that succeeds, on one line."""

    def ask(*arguments):
        out = said(*arguments, "--json")
        assert out.count("\n") == 1
        return json.loads(out)

    return ask


@pytest.fixture
def refused(capsys):
    """Exit status and the one line on standard error of a call that fails."""

    def refused(*arguments):
        with pytest.raises(SystemExit) as exit_:
            main(list(arguments))
        out, err = capsys.readouterr()
        assert out == "" and err.count("\n") == 1
        return exit_.value.code, err.rstrip("\n")

    return refused

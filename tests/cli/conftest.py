"""Calls of the command line, and their outputs when they succeed or fail."""

import contextlib
import io
import json

import pytest

from bouncing_ball.cli.main import main


@pytest.fixture(scope="session")
def outcome():
    """Exit status, output and errors of a call."""

    def outcome(*arguments):
        status = 0
        with (
            contextlib.redirect_stdout(io.StringIO()) as out,
            contextlib.redirect_stderr(io.StringIO()) as err,
        ):
            try:
                main(list(arguments))
            except SystemExit as exit_:
                status = exit_.code
        return status, out.getvalue(), err.getvalue()

    return outcome


@pytest.fixture(scope="session")
def said(outcome):
    """The output of a call that succeeds."""

    def said(*arguments):
        status, out, err = outcome(*arguments)
        assert (status, err) == (0, "")
        return out

    return said


@pytest.fixture(scope="session")
def ask(said):
    """The JSON answer of a call that succeeds, which must be one line."""

    def ask(*arguments):
        out = said(*arguments, "--json")
        assert out.count("\n") == 1
        return json.loads(out)

    return ask


@pytest.fixture(scope="session")
def refused(outcome):
    """Exit status and the one line on standard error of a call that fails."""

    def refused(*arguments):
        status, out, err = outcome(*arguments)
        assert status != 0 and out == "" and err.count("\n") == 1
        return status, err.rstrip("\n")

    return refused

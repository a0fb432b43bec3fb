"""Entry point of ``bouncing-ball``: one subcommand, its answer, and the exit status."""

import json
import sys

from bouncing_ball import __version__
from bouncing_ball.cli.commands import COMMANDS, Program
from bouncing_ball.cli.options import Parser, option
from bouncing_ball.cli.output import fail, say
from bouncing_ball.cli.patience import patience
from bouncing_ball.errors import ModelError, NoOrbitError, ParameterError, extra

INTERRUPTED = 130
"""The exit status after Ctrl-C: 128 and the number of the signal."""


def _program(command: str) -> Program:
    try:
        with extra("pipeline"):
            return COMMANDS[command].program()
    except ModelError as error:
        fail(str(error), status=2)


def parser(arguments: list[str]) -> Parser:
    """The parser of all subcommands; only those named in the arguments have their options."""
    top = Parser(
        prog="bouncing-ball",
        description="Orbits and other motions of a ball on a vibrating table. Quantities are "
        "dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g. Only design has units.",
        epilog="bouncing-ball COMMAND --help explains a command and gives examples",
    )
    top.add_argument("--version", action="version", version=f"{top.prog} {__version__}")
    commands = top.add_subparsers(dest="command", parser_class=Parser)
    for name, command in COMMANDS.items():
        text = command.purpose
        sub = commands.add_parser(name, help=text, description=text, epilog=command.explanation())
        if name in arguments:
            program = _program(name)
            program.add_options(sub)
            if program.lines is not None:
                sub.add_argument("--json", action="store_true", help="one JSON object")
    return top


def main(arguments: list[str] | None = None) -> None:
    """Answer one subcommand; exit with 1 if there is no answer, with 2 on a mistake, and with 130
    if it is interrupted.

    For ``diff`` see :mod:`bouncing_ball.cli.diff`.
    """
    try:
        _answer(sys.argv[1:] if arguments is None else arguments)
    except KeyboardInterrupt:
        fail("interrupted", status=INTERRUPTED)


def _answer(arguments: list[str]) -> None:
    """Answer one subcommand."""
    top = parser(arguments)
    given = vars(top.parse_args(arguments))
    command = given.pop("command")
    as_json = given.pop("json", False)
    if command is None:
        top.error(f"a command is missing, one of {', '.join(COMMANDS)}")
    program = _program(command)
    import numpy as np

    try:
        with np.errstate(all="ignore"), patience(COMMANDS[command].cheaper):
            answer = program.answer(**given)
            if as_json:
                text = json.dumps(program.document(answer), allow_nan=False)
            else:
                text = "\n".join(program.lines(answer) if program.lines else [])
    except ValueError as error:
        text = error.shown(option) if isinstance(error, ParameterError) else str(error)
        if as_json:
            say(json.dumps({"error": text}))
        fail(text, status=1 if isinstance(error, NoOrbitError) else 2)
    say(text)

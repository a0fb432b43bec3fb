"""One subcommand of ``bouncing-ball``: its options, its answer, and the exit status."""

import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from bouncing_ball_beyond.inherited import __version__
from bouncing_ball_beyond.inherited.cli.commands import Command, Program, commands, how_to_install
from bouncing_ball_beyond.inherited.cli.interrupt import importing
from bouncing_ball_beyond.inherited.cli.options import Parser, option
from bouncing_ball_beyond.inherited.cli.output import fail, say
from bouncing_ball_beyond.inherited.cli.patience import told_if_slow
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, ParameterError, extra

COMMANDS: Mapping[str, Command] = commands()
"""The subcommands of this house and of all houses that are installed, by name."""


class _OfCommand(Parser):
    """The parser of a subcommand, which knows the options of the others."""

    def _advice(self, unknown: list[str], given: Any) -> str:
        command = COMMANDS[self.prog.split()[-1]]
        known = self._option_string_actions
        said = command.advice(unknown[0], given or (), known)
        return said or super()._advice(unknown, given)

    def _elsewhere(self, unknown: str) -> str:
        name = unknown.partition("=")[0]
        found = [command for command in COMMANDS if name in _options(command)]
        if not found:
            return ""
        *more, last = found
        return f": it is an option of {', '.join(more)}{' and ' if more else ''}{last}"


@cache
def _options(command: str) -> frozenset[str]:
    """The options of another command; none if it needs an extra that is not installed."""
    alone = Parser(prog=command)
    try:
        _loaded(command).add_options(alone)
    except ModelError:
        return frozenset()
    return frozenset(alone._option_string_actions)


def _loaded(command: str) -> Program:
    with extra("pipeline"), importing():
        return COMMANDS[command].program()


def _program(command: str) -> Program:
    try:
        return _loaded(command)
    except ModelError as error:
        fail(str(error), status=2)


def parser(arguments: list[str]) -> Parser:
    """The parser of all subcommands; only those named in the arguments have their options."""
    top = Parser(
        prog="bouncing-ball",
        description="Orbits of a ball on a vibrating table. Quantities are dimensionless, unless a "
        "command says otherwise: times Ωt, lengths Ω²y/g, velocities Ωẏ/g.",
        epilog="bouncing-ball COMMAND --help explains a command and gives examples",
    )
    top.add_argument("--version", action="version", version=f"{top.prog} {__version__}")
    commands = top.add_subparsers(dest="command", parser_class=_OfCommand)
    for name, command in COMMANDS.items():
        text = command.purpose
        sub = commands.add_parser(name, help=text, description=text, epilog=command.explanation())
        if name in arguments:
            program = _program(name)
            program.add_options(sub)
            if program.lines is not None:
                sub.add_argument("--json", action="store_true", help="one JSON object")
    return top


def answer(arguments: list[str]) -> None:
    """Answer one subcommand; exit with 1 if there is no answer, and with 2 on a mistake."""
    top = parser(arguments)
    first = arguments[0].partition("=")[0] if arguments else ""
    if missing := how_to_install(first):
        if first not in COMMANDS:
            fail(missing, status=2)
    if first.startswith("-") and first not in top._option_string_actions:
        top.error(f"a command is missing before {first}, one of {', '.join(COMMANDS)}")
    given = vars(top.parse_args(arguments))
    command = given.pop("command")
    as_json = given.pop("json", False)
    if command is None:
        top.error(f"a command is missing, one of {', '.join(COMMANDS)}")
    program = _program(command)
    with importing():
        import numpy as np

    try:
        with np.errstate(all="ignore"), told_if_slow(COMMANDS[command].cheaper):
            found = program.answer(**given)
            if as_json:
                text = json.dumps(program.document(found), allow_nan=False)
            else:
                text = "\n".join(program.lines(found) if program.lines else [])
    except ValueError as error:
        names = COMMANDS[command].names
        text = str(error)
        if isinstance(error, ParameterError):
            text = error.shown(lambda name: option(names.get(name, name)))
        if as_json:
            say(json.dumps({"error": text}))
        fail(text, status=1 if isinstance(error, NoOrbitError) else 2)
    say(text)

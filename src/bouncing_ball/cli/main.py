"""Entry point of ``bouncing-ball``: one subcommand, its answer, and the exit status."""

import json
import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any

from bouncing_ball import __version__
from bouncing_ball.cli.help_texts import COMMANDS, explained
from bouncing_ball.cli.options import Parser, add_options, option, positional
from bouncing_ball.cli.output import fail, say
from bouncing_ball.errors import ModelError, NoOrbitError, ParameterError, extra


def _module(command: str) -> Any:
    """The module of a subcommand. It has its call, and may have ``lines`` for readable text."""
    try:
        with extra("pipeline"):
            return import_module(f"bouncing_ball.{COMMANDS[command]['module']}")
    except ModelError as error:
        fail(str(error), status=2)


def _call(command: str) -> Callable[..., Any]:
    return getattr(_module(command), command.replace("-", "_"))


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
        text = command["purpose"]
        sub = commands.add_parser(name, help=text, description=text, epilog=explained(name))
        if name in arguments:
            add_options(sub, _call(name))
            if hasattr(_module(name), "lines"):
                sub.add_argument("--json", action="store_true", help="one JSON object")
    return top


def main(arguments: list[str] | None = None) -> None:
    """Answer one subcommand; exit with 1 if there is no answer, and with 2 on a mistake.

    For ``diff`` see :mod:`bouncing_ball.cli.diff`.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    top = parser(arguments)
    given = vars(top.parse_args(arguments))
    command, as_json = given.pop("command"), given.pop("json", False)
    if command is None:
        top.error(f"a command is missing, one of {', '.join(COMMANDS)}")
    call = _call(command)
    places = [given.pop(name) for name in positional(call)]
    import numpy as np

    try:
        with np.errstate(all="ignore"):
            answer, module = call(*places, **given), _module(command)
            if as_json:
                found = module.document(answer) if hasattr(module, "document") else answer
                text = json.dumps(found, allow_nan=False)
            else:
                text = "\n".join(module.lines(answer))
    except ValueError as error:
        text = error.shown(option) if isinstance(error, ParameterError) else str(error)
        if as_json:
            say(json.dumps({"error": text}))
        fail(text, status=1 if isinstance(error, NoOrbitError) else 2)
    say(text)

"""The options of subcommands that the inherited commands do not have."""

import argparse
import math
from typing import Any

from bouncing_ball_beyond.inherited.cli import options
from bouncing_ball_beyond.inherited.cli.options import Parser
from bouncing_ball_beyond.inherited.errors import Range

NAMES = {"parameters": "set", "amplitudes": "amplitude"}
"""The options that are not called as their parameters."""


def option(name: str) -> str:
    """The option for a parameter.

    Examples
    --------
    >>> option("damping_ratio"), option("parameters")
    ('--damping-ratio', '--set')
    """
    return options.option(NAMES.get(name, name))


def add_file(parser: Parser, name: str, text: str) -> None:
    """Add an option for a file that is written."""
    parser.add_argument(
        option(name), dest=name, type=options.path_of, metavar="FILE", help=options.help_text(text)
    )


def add_interval(parser: Parser, name: str, allowed: Range, text: str) -> None:
    """Add a required option for two numbers in a range."""
    parser.add_argument(
        option(name),
        dest=name,
        type=options.within(allowed),
        nargs=2,
        metavar=("FROM", "TO"),
        required=True,
        help=options.help_text(text),
    )


def add_assignments(parser: Parser, name: str, text: str) -> None:
    """Add an option for assignments such as stiffness=1000, which may be repeated."""
    parser.add_argument(
        option(name),
        dest=name,
        type=_assignment,
        action=_Assignments,
        metavar="NAME=NUMBER",
        help=options.help_text(text),
    )


def _number(text: str) -> float:
    """The number that a text represents, also as a fraction; NaN if it is no number.

    Examples
    --------
    >>> _number("1/250"), _number("0.5"), _number("1/0"), _number("1/x")
    (0.004, 0.5, nan, nan)
    """
    above, slash, below = text.partition("/")
    number = options.to_number(above)
    divisor = options.to_number(below) if slash else 1.0
    return number / divisor if divisor else math.nan


def _assignment(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    number = _number(value)
    if not name.strip() or number not in Range():
        why = f"{text!r} is not NAME=NUMBER, such as stiffness=1000"
        plain = value.lstrip("=")
        if options.to_number(plain) in Range() and name.strip():
            why += f": did you mean {name.strip()}={plain}?"
        elif "=" in value:
            why += ": repeat the option for each parameter"
        elif "=" in text:
            why += options.meant_number(value, Range())
        raise argparse.ArgumentTypeError(why)
    return name.strip(), number


class _Assignments(argparse.Action):
    """Collects assignments to different names in a dictionary."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        found = getattr(namespace, self.dest) or {}
        if values[0] in found:
            parser.error(f"argument {option_string}: {values[0]} is given twice")
        setattr(namespace, self.dest, found | {values[0]: values[1]})

"""The options of ``design`` and ``fit`` that the root's commands do not have."""

import argparse
import inspect
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from bouncing_ball.cli import options
from bouncing_ball.cli.options import Parser, add_parameters, meanings
from bouncing_ball.errors import Range

NAMES = {"parameters": "set", "from_engine": "from", "all_families": "all"}
"""The options that are not called as their parameters."""


def option(name: str) -> str:
    """The option of ``design`` or ``fit`` for a parameter.

    Examples
    --------
    >>> option("contact_time"), option("from_engine")
    ('--contact-time', '--from')
    """
    return options.option(NAMES.get(name, name))


def add_file(parser: Parser, name: str, text: str) -> None:
    """Add an option for a file that is written."""
    parser.add_argument(option(name), dest=name, type=_path, metavar="FILE", help=_help(text))


def _path(text: str) -> Path:
    """The path of a file."""
    # An empty text would be the path of the current folder.
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return Path(text)


def add_optional(parser: Parser, call: Callable, names: Iterable[str]) -> None:
    """Add options for some parameters of a call, of which none is required."""
    texts = meanings(call)
    parameters = inspect.signature(call).parameters
    for name in names:
        if name == "parameters":
            add_assignments(parser, name, texts[name])
        elif name in NAMES:
            parser.add_argument(option(name), dest=name, metavar="X", help=_help(texts[name]))
        else:
            add_parameters(parser, _CallWith(parameters[name], texts[name]))


def _assignment(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    number = options._number(value)
    if not name.strip() or number not in Range():
        why = f"{text!r} is not NAME=NUMBER, such as stiffness=1000"
        if "=" in value:
            why += ": repeat the option for each parameter"
        elif "=" in text:
            why += options._plain(value, Range())
        raise argparse.ArgumentTypeError(why)
    return name.strip(), number


class _Assignments(argparse.Action):
    """Collects assignments to different names in a dictionary."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        found = getattr(namespace, self.dest) or {}
        if values[0] in found:
            parser.error(f"argument {option_string}: {values[0]} is given twice")
        setattr(namespace, self.dest, found | {values[0]: values[1]})


def add_assignments(parser: Parser, name: str, text: str) -> None:
    """Add an option for assignments such as stiffness=1000, which may be repeated."""
    parser.add_argument(
        option(name),
        dest=name,
        type=_assignment,
        action=_Assignments,
        metavar="NAME=NUMBER",
        help=_help(text),
    )


def _help(text: str) -> str:
    # argparse fills in what follows a percent sign.
    return text.replace("%", "%%")


class _CallWith:
    """A call that has one parameter alone, which is not required, for :func:`add_parameters`."""

    def __init__(self, parameter: inspect.Parameter, text: str) -> None:
        if parameter.name == "law":
            text += laws()
        if parameter.default is parameter.empty:
            parameter = parameter.replace(default=None)
        self.__doc__ = f"Parameters\n----------\n{parameter.name}\n    {text}"
        self.__signature__ = inspect.Signature([parameter])

    def __call__(self) -> None:
        """Nothing: only the signature and the docstring are read."""


def laws() -> str:
    """A sentence with the names of the contact laws."""
    # Imported here, because the import needs numpy, which the general help does not need.
    from bouncing_ball_contacts.engines.laws import LAWS

    return f" Laws: {', '.join(LAWS)}."

"""The options of a subcommand, made from the signature and the docstring of its call."""

import argparse
import builtins
import collections.abc
import enum
import inspect
import math
import pathlib
import re
import sys
import typing
from collections.abc import Callable
from typing import Any, NoReturn

from bouncing_ball.cli.output import say
from bouncing_ball.errors import Range, escaped

_OTHER_NAMES = {"parameters": "set", "from_engine": "from", "all_families": "all"}
_OTHER_NAMES |= {"amplitudes": "amplitude"}


class Parser(argparse.ArgumentParser):
    """A parser that prints one line on an error and exits with status 2."""

    def __init__(self, *args: Any, **options: Any) -> None:
        # The line breaks of the explanation and of the examples are kept.
        options["formatter_class"] = argparse.RawDescriptionHelpFormatter
        super().__init__(*args, **options)
        # A value such as -1e6 or -5N/m is no option, as in Python 3.14.
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog.split()[0]}: {escaped(message)}\n")

    def _print_message(self, message: str, file: Any = None) -> None:
        # argparse prints no message if the help cannot be written.
        if file is sys.stdout:
            say(message.rstrip("\n"))
        else:
            super()._print_message(message, file)


def option(name: str) -> str:
    """The option of the command line for a parameter.

    Examples
    --------
    >>> option("damping_ratio")
    '--damping-ratio'
    """
    return "--" + _OTHER_NAMES.get(name, name).replace("_", "-")


def meanings(call: Callable) -> dict[str, str]:
    """The description of each parameter from the docstring of a call.

    Parameters that the call hands on are described by the docstring of the other call.

    Examples
    --------
    >>> meanings(meanings)
    {}
    """
    handed_on = getattr(call, "handed_on", None)
    found = meanings(handed_on) if handed_on else {}
    entries = re.findall(
        r"^(\w+(?:, \w+)*)(?: : .*)?\n((?: {4}.+\n?)+)", inspect.getdoc(call) or "", re.MULTILINE
    )
    for names, text in entries:
        found |= dict.fromkeys(names.split(", "), " ".join(text.split()))
    return found


def _number(text: str, kind: Any = float) -> float:
    """The number that a text represents; NaN if it is no number."""
    try:
        return int(text) if kind is int else float(text)
    except ValueError:
        return math.nan


def _assignment(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    number = _number(value)
    if not name or number not in Range():
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=NUMBER, such as stiffness=1000")
    return name, number


class _Assignments(argparse.Action):
    """Collects assignments to different names in a dictionary."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        found = getattr(namespace, self.dest) or {}
        if values[0] in found:
            parser.error(f"argument {option_string}: {values[0]} is given twice")
        setattr(namespace, self.dest, found | {values[0]: values[1]})


def _within(allowed: Range) -> Callable[[str], Any]:
    """A parser of numbers in a range, for the argument ``type`` of an option."""

    def parse(text: str) -> Any:
        value = _number(text, int if allowed.whole else float)
        if value not in allowed:
            raise argparse.ArgumentTypeError(f"{text!r} is not {allowed}")
        return value

    return parse


def _reading(annotation: Any) -> dict[str, Any]:
    """The arguments of ``add_argument`` for a parameter with this annotation."""
    kinds = typing.get_args(annotation)
    if type(None) in kinds:
        # X | None is read as X.
        return _reading(kinds[0])
    match typing.get_origin(annotation) or annotation:
        case typing.Annotated if isinstance(kinds[1], Range):
            return {"type": _within(kinds[1]), "metavar": "N" if kinds[1].whole else "X"}
        case typing.Annotated if isinstance(kinds[1], enum.EnumType):
            return {"choices": list(map(str, kinds[1].__members__.values()))}
        case typing.Literal:
            return {"choices": kinds}
        case builtins.tuple if kinds[-1] is not ...:
            return _reading(kinds[0]) | {"nargs": 2, "metavar": ("FROM", "TO")}
        case builtins.bool:
            return {"action": "store_true"}
        case collections.abc.Mapping:
            return {"type": _assignment, "action": _Assignments, "metavar": "NAME=NUMBER"}
        case pathlib.Path:
            return {"type": pathlib.Path, "metavar": "FILE"}
    # A text, or a quantity with a unit, which the call converts.
    return {"metavar": "X"}


def positional(call: Callable) -> list[str]:
    """The parameters that are arguments by position on the command line."""
    found = inspect.signature(call).parameters.values()
    return [p.name for p in found if p.kind is p.POSITIONAL_ONLY]


def add_options(parser: argparse.ArgumentParser, call: Callable) -> None:
    """Add one option for each parameter, and an argument for each positional-only parameter."""
    texts, parameters = meanings(call), inspect.signature(call, eval_str=True).parameters
    for name, parameter in parameters.items():
        reading, text = _reading(parameter.annotation), texts.get(name, "")
        required, default = parameter.default is parameter.empty, parameter.default
        if parameter.kind is parameter.POSITIONAL_ONLY:
            # Without a default, argparse would list an optional list of arguments as required.
            several: dict[str, Any] = {} if required else {"nargs": "*", "default": []}
            reading["metavar"] = name.upper()
            parser.add_argument(name, **reading, **several, help=text)
            continue
        if not required and default not in (None, False):
            shown = f"{default:.4g}" if isinstance(default, float) else default
            text += f" (default: {shown})"
        if name == "law":
            # Imported here, because the import needs numpy, which the general help does not need.
            from bouncing_ball.beyond.laws.registry import LAWS

            text += f" Laws: {', '.join(LAWS)}."
        reading |= {"default": None if required else default, "help": text.replace("%", "%%")}
        parser.add_argument(option(name), dest=name, required=required, **reading)

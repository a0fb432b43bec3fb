"""Options of a subcommand, from the signature and the docstring of its call."""

import argparse
import inspect
import math
import re
import sys
import typing
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NoReturn

from bouncing_ball.cli.output import print_lines
from bouncing_ball.errors import escaped
from bouncing_ball.signatures import Range

_OTHER_NAMES = {"parameters": "set"}


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line and exit status 2."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        # A value such as -1e6 or -5N/m is no option; Python 3.14 reads them so itself.
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {escaped(message)}\n")

    def _print_message(self, message: str, file: Any = None) -> None:
        # argparse itself says nothing where the help cannot be written.
        if file is sys.stdout:
            print_lines(message.splitlines())
        else:
            super()._print_message(message, file)


def option(name: str) -> str:
    """The option of a parameter.

    Examples
    --------
    >>> option("damping_ratio")
    '--damping-ratio'
    """
    return "--" + _OTHER_NAMES.get(name, name).replace("_", "-")


def in_options(text: str) -> str:
    """A text with ``{parameter}`` as its option."""
    return re.sub(r"{(\w+)}", lambda found: option(found[1]), text)


def meanings(call: Callable) -> dict[str, str]:
    """What the docstring says of each parameter, and of those that are handed on.

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


def _assignment(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    try:
        if not (name and equals):
            raise argparse.ArgumentTypeError
        return name, _within(Range())(value)
    except argparse.ArgumentTypeError:
        example = "NAME=NUMBER, as stiffness=1000"
        raise argparse.ArgumentTypeError(f"{text!r} is not {example}") from None


def _within(allowed: Range, kind: Any = float) -> Callable[[str], Any]:
    """A parser of numbers in a range, for ``type=``."""

    def parse(text: str) -> Any:
        try:
            value = int(text) if kind is int else float(text)
        except ValueError:
            value = math.nan
        if value not in allowed:
            whole = f"a whole number from {allowed.low:g} to {allowed.high:.0f}"
            what = whole if kind is int else allowed
            raise argparse.ArgumentTypeError(f"{text!r} is not {what}")
        return value

    return parse


def _reading(annotation: Any) -> dict[str, Any]:
    """How argparse reads a value of a type."""
    # X | None is read as X is.
    kinds = [each for each in typing.get_args(annotation) if each is not type(None)]
    if type(None) in typing.get_args(annotation):
        return _reading(kinds[0])
    origin = typing.get_origin(annotation)
    if origin is typing.Annotated:
        kind, how = kinds
        if isinstance(how, Range):
            return {"type": _within(how, kind), "metavar": "N" if kind is int else "X"}
        # A parser of one's own, or a unit, which the call itself reads.
        return {"type": how, "metavar": "FILE"} if callable(how) else {"metavar": "X"}
    if origin is typing.Literal:
        return {"choices": kinds}
    if origin is Mapping:
        return {"type": _assignment, "action": "append", "metavar": "NAME=NUMBER"}
    return {"metavar": "X"} | ({"type": annotation} if annotation in (int, str, Path) else {})


def positional(call: Callable) -> list[str]:
    """The parameters that are given by their places."""
    found = inspect.signature(call).parameters.values()
    return [p.name for p in found if p.kind is p.POSITIONAL_ONLY]


def add_options(parser: argparse.ArgumentParser, call: Callable) -> list[str]:
    """One option for each parameter, and arguments for those that are positional only.

    Returns the names of the parameters.
    """
    texts, parameters = meanings(call), inspect.signature(call, eval_str=True).parameters
    for name, parameter in parameters.items():
        reading, text = _reading(parameter.annotation), texts.get(name, "")
        required, default = parameter.default is parameter.empty, parameter.default
        if parameter.kind is parameter.POSITIONAL_ONLY:
            # Several arguments need a default, or argparse calls them required.
            several: dict[str, Any] = {} if required else {"nargs": "*", "default": []}
            reading["metavar"] = name.upper()
            parser.add_argument(name, **reading, **several, help=text)
            continue
        if not required and default not in (None, False):
            shown = f"{default:.4g}" if isinstance(default, float) else default
            text += f" (default: {shown})"
        parser.add_argument(
            option(name),
            dest=name,
            required=required,
            default=None if required else default,
            help=text.replace("%", "%%"),
            **reading,
        )
    return list(parameters)

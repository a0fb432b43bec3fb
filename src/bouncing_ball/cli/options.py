"""The options of subcommands.

Their descriptions are those of the docstrings of the calls. Options that are parameters of one call
are made from its signature.
"""

import argparse
import builtins
import enum
import inspect
import math
import pathlib
import re
import sys
import typing
from collections.abc import Callable, Iterable
from typing import Any, NoReturn

from bouncing_ball.cli.advice import advice, meaning
from bouncing_ball.cli.output import say
from bouncing_ball.errors import Range, escaped


class Parser(argparse.ArgumentParser):
    """A parser that prints one line on an error and exits with status 2."""

    def __init__(self, *args: Any, **options: Any) -> None:
        # The line breaks of the explanation and of the examples are kept.
        options["formatter_class"] = argparse.RawDescriptionHelpFormatter
        # The beginning of an option is none: --frequency in Hz is no --frequency-ratio.
        options["allow_abbrev"] = False
        super().__init__(*args, **options)
        # A value such as -1e6 or -5N/m is no option, as in Python 3.14.
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        message = message.replace("ignored explicit argument", "it takes no value, not")
        self.exit(2, f"{self.prog.split()[0]}: {escaped(message)}\n")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        namespace, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}{self._advice(unknown, args)}")
        return namespace, unknown

    def _advice(self, unknown: list[str], given: Any) -> str:
        """A clause on the first argument that is not recognized."""
        known = self._option_string_actions
        command = self.prog.split()[-1]
        said = advice(unknown[0], given or (), command, known) or self._elsewhere(unknown[0])
        return said or f": see {self.prog} --help"

    def _elsewhere(self, unknown: str) -> str:
        """A clause on an argument that other parsers know; empty if there are none."""
        return ""

    def _match_argument(self, action: argparse.Action, arg_strings_pattern: str) -> int:
        try:
            return super()._match_argument(action, arg_strings_pattern)
        except argparse.ArgumentError as error:
            if isinstance(action.metavar, tuple):
                error.message += f", {' and '.join(action.metavar)}, with a space between them"
            raise

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            is_option = f"--{value}" in self._option_string_actions
            choices = list(map(str, action.choices or ()))
            error.message += f"; did you mean --{value}?" if is_option else meaning(value, choices)
            raise

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
    return "--" + name.replace("_", "-")


def meanings(call: Callable) -> dict[str, str]:
    """The description of each parameter from the docstring of a call.

    Examples
    --------
    >>> from bouncing_ball.models.restitution import rigid
    >>> meanings(rigid)["restitution"]
    'Restitution coefficient r in (0, 1].'
    """
    found: dict[str, str] = {}
    section = re.search(
        r"^Parameters\n-+\n(.*?)(?:\n\n\w+\n-+\n|\Z)",
        inspect.getdoc(call) or "",
        re.DOTALL | re.MULTILINE,
    )
    entry = r"^(\w+(?:, \w+)*)(?: : .*)?\n((?: {4}.+\n?)+)"
    for names, text in re.findall(entry, section[1] if section else "", re.MULTILINE):
        found |= dict.fromkeys(names.split(", "), " ".join(text.split()))
    return found


def _number(text: str, kind: Any = float) -> float:
    """The number that a text represents; NaN if it is no number."""
    try:
        return int(text) if kind is int else float(text)
    except ValueError:
        return math.nan


def _path(text: str) -> pathlib.Path:
    """The path of a file or a folder."""
    # An empty text would be the path of the current folder.
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return pathlib.Path(text)


def _within(allowed: Range) -> Callable[[str], Any]:
    """A parser of numbers in a range, for the argument ``type`` of an option."""

    def parse(text: str) -> Any:
        value = _number(text, int if allowed.whole else float)
        if value not in allowed:
            raise argparse.ArgumentTypeError(f"{text!r} is not {allowed}{_plain(text, allowed)}")
        return value

    return parse


def _plain(text: str, allowed: Range) -> str:
    """A clause on how a number is written that was probably meant; empty if none was.

    Examples
    --------
    >>> _plain("85 %", Range(0, 1, "(]")), _plain("0,85", Range(0, 1, "(]"))
    (': did you mean 0.85?', ': did you mean 0.85?')
    >>> _plain("50 Hz", Range(0)), _plain("x", Range(0))
    (': give it without a unit', '')
    """
    share = text.strip().removesuffix("%")
    in_percent = allowed.high == 1 and (share != text or _FEW <= _number(share) < _WHOLE)
    for meant in (_number(text.replace(",", ".")), _number(share) / _WHOLE if in_percent else None):
        if meant in allowed:
            return f": did you mean {meant:g}?"
    has_unit = re.match(r"\s*[+-]?\.?\d", text) and math.isnan(_number(text)) and "," not in text
    return ": give it without a unit" if has_unit else ""


# Percent in a whole, and the fewest that a number without a sign may mean: 1.5 is a slip for 0.5.
_WHOLE = 100
_FEW = 5


def add_number(
    parser: argparse.ArgumentParser,
    name: str,
    allowed: Range,
    text: str,
    *,
    required: bool = False,
    default: float | None = None,
) -> None:
    """Add an option for a number in a range."""
    parser.add_argument(
        option(name),
        dest=name,
        type=_within(allowed),
        metavar="N" if allowed.whole else "X",
        required=required,
        default=default,
        help=_help(text, default),
    )


def add_choice(
    parser: argparse.ArgumentParser,
    name: str,
    choices: Iterable[str],
    text: str,
    *,
    default: str | None = None,
) -> None:
    """Add an option for one of several names."""
    parser.add_argument(
        option(name),
        dest=name,
        # The members of an enumeration are shown by their values.
        choices=list(map(str, choices)),
        default=default,
        help=_help(text, default),
    )


def _help(text: str, default: Any) -> str:
    if default not in (None, False):
        shown = f"{default:.4g}" if isinstance(default, float) else default
        text += f" (default: {shown})"
    # argparse fills in what follows a percent sign.
    return text.replace("%", "%%")


def add_parameters(parser: argparse.ArgumentParser, call: Callable) -> None:
    """Add one option for each parameter of a call, and an argument for each positional-only one."""
    texts = meanings(call)
    for name, parameter in inspect.signature(call).parameters.items():
        if parameter.kind is parameter.POSITIONAL_ONLY:
            _add_argument(parser, parameter, texts.get(name, ""))
        else:
            _add_option(parser, parameter, texts.get(name, ""))


def _add_argument(parser: argparse.ArgumentParser, parameter: inspect.Parameter, text: str) -> None:
    """Add an argument by position."""
    reading = _reading(parameter.annotation)
    if parameter.default is not parameter.empty:
        # Without a default, argparse would list an optional list of arguments as required.
        reading |= {"nargs": "*", "default": []}
    reading["metavar"] = parameter.name.upper()
    parser.add_argument(parameter.name, **reading, help=text)


def _add_option(parser: argparse.ArgumentParser, parameter: inspect.Parameter, text: str) -> None:
    required = parameter.default is parameter.empty
    default = None if required else parameter.default
    reading = _reading(parameter.annotation)
    reading |= {"default": default, "help": _help(text, default), "required": required}
    parser.add_argument(option(parameter.name), dest=parameter.name, **reading)


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
        case builtins.bool:
            return {"action": "store_true"}
        case pathlib.Path:
            return {"type": _path, "metavar": "FILE"}
    # A text, or a quantity with a unit, which the call converts.
    return {"metavar": "X"}

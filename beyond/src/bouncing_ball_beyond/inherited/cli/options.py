"""The options of subcommands, and what was probably meant by an argument that is none of them.

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
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import Any, NoReturn

from bouncing_ball_beyond.inherited.cli.output import say
from bouncing_ball_beyond.inherited.errors import Range, did_you_mean, escaped

# Other words for options, and the symbols of textbooks.
_WORDS = {
    "e": "restitution",
    "r": "restitution",
    "cor": "restitution",
    "coefficient-of-restitution": "restitution",
    "zeta": "damping-ratio",
    "omega": "frequency-ratio",
    "v": "velocity",
    "tol": "tolerance",
    "lambda": "amplitude",
}
# Dashes that an editor puts in place of two hyphens.
DASHES = "-—–−"
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
# Percent in a whole, and the fewest that a number without a sign may mean: 1.5 is a slip for 0.5.
_WHOLE = 100
_FEW = 5


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


def advice(
    unknown: str, arguments: Sequence[str], command: str, known: Mapping[str, argparse.Action]
) -> str:
    """A clause on the first argument that is not recognized; empty if nothing is known of it.

    Parameters
    ----------
    unknown : str
        The argument.
    arguments : sequence of str
        All arguments of the command.
    command : str
        Name of the command.
    known : mapping
        The options of the command.

    Examples
    --------
    >>> parser = argparse.ArgumentParser()
    >>> _ = parser.add_argument("--restitution")
    >>> known = parser._option_string_actions
    >>> advice("--cor", ["--cor", "0.8"], "limits", known)
    '; did you mean --restitution?'
    >>> advice("Hz", ["--restitution", "10", "Hz"], "limits", known)
    ': numbers of limits have no unit'
    """
    name = unknown.partition("=")[0]
    if not is_option(name):
        return _of_value(name, arguments, command, known)
    word = name.lstrip(DASHES).replace("_", "-")
    meant = _WORDS.get(word, word)
    if f"--{meant}" in known:
        return f"; did you mean --{meant}?"
    return meaning(f"--{word}", known)


def is_option(argument: str) -> bool:
    """Whether an argument is no value; a negative number is a value."""
    return argument[:1] in tuple(DASHES) and not NUMBER.match(argument)


def _of_value(
    value: str, arguments: Sequence[str], command: str, known: Mapping[str, argparse.Action]
) -> str:
    """A clause on an argument that is no option."""
    if f"--{value}" in known:
        return f"; did you mean --{value}?"
    name, before = preceding(value, arguments, known)
    if not name:
        return ""
    action = known[name]
    if action.nargs == 0:
        return f": {name} takes no value"
    if NUMBER.fullmatch(before) and not NUMBER.fullmatch(value):
        return f": numbers of {command} have no unit"
    return f": {name} takes {'one value' if action.nargs is None else f'{action.nargs} values'}"


def preceding(value: str, arguments: Sequence[str], known: Collection[str]) -> tuple[str, str]:
    """The last option before an argument, empty if there is none, and the value just before it.

    Examples
    --------
    >>> preceding("Hz", ["--frequency=10", "Hz"], ["--frequency"])
    ('--frequency', '10')
    """
    place = list(arguments).index(value) if value in arguments else 0
    options = [each for each in arguments[:place] if each.partition("=")[0] in known]
    if not options:
        return "", ""
    name, has_value, _ = options[-1].partition("=")
    return name, arguments[place - 1].partition("=")[2 if has_value else 0]


def meaning(text: str, known: Iterable[str]) -> str:
    """A clause that suggests the known name that a wrong one resembles, begins or ends.

    Examples
    --------
    >>> meaning("--amplitude", ["--acceleration", "--table-amplitude"])
    '; did you mean --table-amplitude?'
    >>> meaning("--frequency", ["--amplitude", "--frequency-ratio"])
    '; did you mean --frequency-ratio?'
    """
    names = list(known)
    part = text.removeprefix("--").replace("_", "-")
    plain = {name: name.removeprefix("--").replace("_", "-") for name in names}
    longer = [
        name
        for name, each in plain.items()
        if each.endswith(f"-{part}") or (part and each.startswith(part))
    ]
    # Dashes are no letters that two names have in common.
    alike = did_you_mean(part, plain.values())
    for name, each in plain.items():
        if alike == f"; did you mean {each}?":
            return f"; did you mean {name}?"
    return did_you_mean("".join(longer[:1]), longer)


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
    >>> from bouncing_ball_beyond.inherited.models.spring_damper import spring_damper
    >>> meanings(spring_damper)["frequency_ratio"]
    'Frequency ratio ϖ of a spring-damper contact; the restitution model has none.'
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


def to_number(text: str, kind: Any = float) -> float:
    """The number that a text represents; NaN if it is no number."""
    try:
        return int(text) if kind is int else float(text)
    except ValueError:
        return math.nan


def path_of(text: str) -> pathlib.Path:
    """The path of a file or a folder."""
    # An empty text would be the path of the current folder.
    if not text:
        raise argparse.ArgumentTypeError("the name is empty")
    return pathlib.Path(text)


def within(allowed: Range) -> Callable[[str], Any]:
    """A parser of numbers in a range, for the argument ``type`` of an option."""

    def parse(text: str) -> Any:
        value = to_number(text, int if allowed.whole else float)
        if value not in allowed:
            raise argparse.ArgumentTypeError(
                f"{text!r} is not {allowed}{meant_number(text, allowed)}"
            )
        return value

    return parse


def meant_number(text: str, allowed: Range) -> str:
    """A clause on how a number is written that was probably meant; empty if none was.

    Examples
    --------
    >>> meant_number("85 %", Range(0, 1, "(]")), meant_number("0,85", Range(0, 1, "(]"))
    (': did you mean 0.85?', ': did you mean 0.85?')
    >>> meant_number("50 Hz", Range(0)), meant_number("x", Range(0))
    (': give it without a unit', '')
    """
    share = text.strip().removesuffix("%")
    in_percent = allowed.high == 1 and (share != text or _FEW <= to_number(share) < _WHOLE)
    for meant in (
        to_number(text.replace(",", ".")),
        to_number(share) / _WHOLE if in_percent else None,
    ):
        if meant in allowed:
            return f": did you mean {meant:g}?"
    has_unit = re.match(r"\s*[+-]?\.?\d", text) and math.isnan(to_number(text)) and "," not in text
    return ": give it without a unit" if has_unit else ""


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
        type=within(allowed),
        metavar="N" if allowed.whole else "X",
        required=required,
        default=default,
        help=help_text(text, default),
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
        help=help_text(text, default),
    )


def help_text(text: str, default: Any = None) -> str:
    """The text of an option in the help, with its default if it has one."""
    if default not in (None, False):
        shown = f"{default:.4g}" if isinstance(default, float) else default
        text += f" (default: {shown})"
    # argparse fills in what follows a percent sign.
    return text.replace("%", "%%")


def add_parameters(parser: argparse.ArgumentParser, call: Callable) -> None:
    """Add one option for each parameter of a call, and an argument for each positional-only one."""
    texts = meanings(call)
    for name, parameter in inspect.signature(call).parameters.items():
        text = texts.get(name, "")
        reading = _reading(parameter.annotation)
        required = parameter.default is parameter.empty
        if parameter.kind is parameter.POSITIONAL_ONLY:
            if not required:
                # Without a default, argparse would list an optional list of arguments as required.
                reading |= {"nargs": "*", "default": []}
            parser.add_argument(name, **(reading | {"metavar": name.upper()}), help=text)
        else:
            default = None if required else parameter.default
            reading |= {"default": default, "help": help_text(text, default)}
            parser.add_argument(option(name), dest=name, required=required, **reading)


def _reading(annotation: Any) -> dict[str, Any]:
    """The arguments of ``add_argument`` for a parameter with this annotation."""
    kinds = typing.get_args(annotation)
    if type(None) in kinds:
        # X | None is read as X.
        return _reading(kinds[0])
    match typing.get_origin(annotation) or annotation:
        case typing.Annotated if isinstance(kinds[1], Range):
            return {"type": within(kinds[1]), "metavar": "N" if kinds[1].whole else "X"}
        case typing.Annotated if isinstance(kinds[1], enum.EnumType):
            return {"choices": list(map(str, kinds[1].__members__.values()))}
        case typing.Literal:
            return {"choices": kinds}
        case builtins.bool:
            return {"action": "store_true"}
        case pathlib.Path:
            return {"type": path_of, "metavar": "FILE"}
    # A text, or a quantity with a unit, which the call converts.
    return {"metavar": "X"}

"""What was probably meant by an argument that a subcommand does not know."""

import argparse
import re
from collections.abc import Collection, Iterable, Mapping, Sequence

from bouncing_ball.errors import did_you_mean

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

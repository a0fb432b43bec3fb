"""What was probably meant by an argument that a subcommand does not know."""

import argparse
import re
from collections.abc import Iterable, Mapping, Sequence

from bouncing_ball.errors import did_you_mean

WITH_UNITS = ("design", "fit")
"""The commands whose options have units."""
# Other words for options, and the symbols of textbooks.
_WORDS = {
    "e": "restitution",
    "r": "restitution",
    "cor": "restitution",
    "coefficient-of-restitution": "restitution",
    "k": "stiffness",
    "spring": "stiffness",
    "spring-constant": "stiffness",
    "c": "damping",
    "dashpot": "damping",
    "zeta": "damping-ratio",
    "m": "mass",
    "weight": "mass",
    "f": "frequency",
    "omega": "angular-frequency",
    "t": "period",
    "v": "speed",
    "impact-speed": "speed",
    "g": "gravity",
    "dt": "time-step",
    "tol": "tolerance",
    "lambda": "amplitude",
    "all-families": "all",
}
# Dashes that an editor puts in place of two hyphens.
_DASHES = "-—–−"
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


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
    word = name.lstrip(_DASHES).replace("_", "-")
    if name[:1] not in tuple(_DASHES):
        return _of_value(name, arguments, command, known)
    # A negative number is a value.
    if _NUMBER.match(name):
        return _of_value(name, arguments, command, known)
    # The radius is half of it, so that the option is not just another name.
    if word == "diameter" and "--radius" in known:
        return "; did you mean --radius, half of it?"
    meant = _WORDS.get(word, word)
    if f"--{meant}" in known:
        return f"; did you mean --{meant}?"
    if command == "design" and (engine := _engine_with(name.removeprefix("--"))):
        return _of_engine(name.removeprefix("--"), engine)
    return meaning(f"--{word}", known)


def _of_value(
    value: str, arguments: Sequence[str], command: str, known: Mapping[str, argparse.Action]
) -> str:
    """A clause on an argument that is no option."""
    if command == "design" and (engine := _engine_with(value)):
        return _of_engine(value, engine)
    if f"--{value}" in known:
        return f"; did you mean --{value}?"
    place = list(arguments).index(value) if value in arguments else 0
    options = [each for each in arguments[:place] if each.partition("=")[0] in known]
    if not options:
        return ""
    name, has_value, _ = options[-1].partition("=")
    action = known[name]
    if action.nargs == 0:
        return f": {name} takes no value"
    if _NUMBER.fullmatch(arguments[place - 1].partition("=")[2 if has_value else 0]):
        if command in WITH_UNITS:
            return ': a value with a space is one argument in quotes, such as "20 g"'
        if not _NUMBER.fullmatch(value):
            return f": numbers of {command} have no unit"
    return f": {name} takes {'one value' if action.nargs is None else f'{action.nargs} values'}"


def _of_engine(parameter: str, engine: str) -> str:
    return f": it is a parameter of {engine}: --from {engine} --set {parameter}=NUMBER"


def _engine_with(parameter: str) -> str:
    """The first engine that has a parameter of this name; empty if none has.

    Examples
    --------
    >>> _engine_with("kn"), _engine_with("mass")
    ('lammps', '')
    """
    # Imported here, because the import needs numpy, which the help does not need.
    from bouncing_ball.contacts.engines.choice import ENGINES

    plain = ("stiffness", "damping", "solref", "solimp")
    name = parameter.partition("=")[0]
    known = (one.name for one in ENGINES.values() if name in one.names)
    return "" if name in plain else next(known, "")


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

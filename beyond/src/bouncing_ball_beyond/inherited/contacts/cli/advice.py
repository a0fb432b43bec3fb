"""What was probably meant by an argument that ``design`` does not know.

What all commands have in common is in :mod:`bouncing_ball_beyond.inherited.cli.options`, which is
asked next.
"""

from collections.abc import Collection, Iterable, Sequence

from bouncing_ball_beyond.inherited.cli.options import DASHES, NUMBER, is_option, preceding

# Other words for options, and the symbols of textbooks.
_WORDS = {
    "k": "stiffness",
    "spring": "stiffness",
    "spring-constant": "stiffness",
    "c": "damping",
    "dashpot": "damping",
    "m": "mass",
    "weight": "mass",
    "f": "frequency",
    "omega": "frequency",
    "angular-frequency": "frequency",
    "period": "frequency",
    "v": "speed",
    "impact-speed": "speed",
    "g": "gravity",
    "all-families": "all",
}
_WITHOUT_VALUE = ("--all",)


def advice_of_design(unknown: str, arguments: Sequence[str], known: Iterable[str]) -> str:
    """A clause on the first argument that ``design`` does not know; empty if nothing is known.

    The parameters are those of :func:`bouncing_ball_beyond.inherited.cli.options.advice`.

    Examples
    --------
    >>> advice_of_design("--k", ["--k", "100"], ["--stiffness"])
    '; did you mean --stiffness?'
    >>> advice_of_design("--kn", ["--kn", "100"], ["--stiffness"])
    ': it is a parameter of lammps: --from lammps --set kn=NUMBER'
    """
    name = unknown.partition("=")[0]
    found = _of_design(unknown, arguments, known)
    if found and is_option(name):
        return found
    parameter = name.removeprefix("--")
    if engine := _engine_with(parameter):
        return f": it is a parameter of {engine}: --from {engine} --set {parameter}=NUMBER"
    return found


def _of_design(unknown: str, arguments: Sequence[str], known: Iterable[str]) -> str:
    """A clause on the first argument that is no parameter of an engine.

    The parameters are those of :func:`advice_of_design`.

    Examples
    --------
    >>> _of_design("g", ["--mass", "454", "g"], ["--mass"])
    ': a value with a space is one argument in quotes, such as "20 g"'
    """
    options = list(known)
    name = unknown.partition("=")[0]
    if not is_option(name):
        return _of_value(name, arguments, options)
    word = name.lstrip(DASHES).replace("_", "-")
    # The radius is half of it, so that the option is not just another name.
    if word == "diameter" and "--radius" in options:
        return "; did you mean --radius, half of it?"
    meant = _WORDS.get(word, "")
    return f"; did you mean --{meant}?" if f"--{meant}" in options else ""


def _of_value(value: str, arguments: Sequence[str], known: Collection[str]) -> str:
    """A clause on an argument that follows a number; empty elsewhere."""
    if f"--{value}" in known:
        return ""
    last, before = preceding(value, arguments, known)
    if not last or last in _WITHOUT_VALUE or not NUMBER.fullmatch(before):
        return ""
    return ': a value with a space is one argument in quotes, such as "20 g"'


def _engine_with(parameter: str) -> str:
    """The first engine that has a parameter of this name; empty if none has.

    Examples
    --------
    >>> _engine_with("kn"), _engine_with("mass")
    ('lammps', '')
    """
    # Imported here, because the import needs numpy, which the help does not need.
    from bouncing_ball_beyond.inherited.contacts.engines.choice import ENGINES

    plain = ("stiffness", "damping", "solref", "solimp")
    name = parameter.partition("=")[0]
    known = (one.name for one in ENGINES.values() if name in one.names)
    return "" if name in plain else next(known, "")

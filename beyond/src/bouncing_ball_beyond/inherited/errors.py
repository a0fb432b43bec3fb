"""The errors that a user can cause, with messages of one line.

All of them derive from :class:`ValueError`, so that callers can catch them without a distinction.
"""

import difflib
import functools
import inspect
import math
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
_Known = TypeVar("_Known")
_Call = TypeVar("_Call", bound=Callable[..., Any])
# Characters of a value in a message.
_VALUE = 80


class ModelError(ValueError):
    """A parameter outside the range in which the model is defined."""


class ParameterError(ModelError):
    """A parameter of a call that is missing, not allowed, or in contradiction to another.

    ``{name}`` in the text stands for a parameter, which the command line shows as its option, and
    each ``{}`` for one of the values that follow the text. A value may contain braces.

    Examples
    --------
    >>> str(ParameterError("{duration} needs {law}, not {}", "{a}"))
    'duration needs law, not {a}'
    """

    def __str__(self) -> str:
        return self.shown(str)

    def shown(self, named: Callable[[str], str]) -> str:
        """The message with ``named(name)`` for each parameter."""
        text, *values = self.args
        rest = iter(values)

        def entry(found: re.Match) -> str:
            if found[1]:
                return named(found[1])
            # A value of a user may be an array or an object of many lines.
            return printable(" ".join(str(next(rest, found[0])).split()), _VALUE)

        return re.sub(r"{(\w*)}", entry, text)


class NoOrbitError(ValueError):
    """The requested periodic orbit does not exist; the message gives the reason."""


@contextmanager
def extra(name: str) -> Iterator[None]:
    """A context for imports that need an extra of the package.

    If a package is missing, the error is one line that tells how to install the extra.

    Raises
    ------
    ModelError
        If a package of this extra is not installed.

    Examples
    --------
    >>> with extra("plot"):
    ...     import no_such_package
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: no_such_package is not installed: \
install the extra 'plot', for example pip install "./beyond[plot]"
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package = str(error.name).partition(".")[0]
        raise ModelError(
            f"{package} is not installed: "
            f'install the extra {name!r}, for example pip install "./beyond[{name}]"'
        ) from None


def require(valid: "ArrayLike", value: "ArrayLike", name: str, allowed: str) -> None:
    """Raise :class:`ModelError` with the first value that is not valid, if there is one.

    Examples
    --------
    >>> require([True, False], [0.5, 1.5], "restitution coefficient r", "in (0, 1]")
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: restitution coefficient r = 1.5 is not in \
(0, 1]
    """
    # Imported here, because the command line imports this module, and --help needs no numpy.
    import numpy as np

    if not np.asarray(valid).all():
        valid, value = np.broadcast_arrays(valid, value)
        first = value[~valid][0]
        raise ModelError(f"{name} = {first} is not {allowed}")


def one_of(kind: str, name: str, known: Mapping[str, _Known]) -> _Known:
    """The entry of a mapping under a name that a user gave.

    Raises
    ------
    ModelError
        If the name is unknown; the error lists the names that are known.

    Examples
    --------
    >>> one_of("side", "left", {"stable": 1, "unstable": -1})
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ModelError: unknown side 'left': one of stable, unstable
    """
    if not isinstance(name, str) or name not in known:
        meant = did_you_mean(name, known) if isinstance(name, str) else ""
        listed = ", ".join(known)
        raise ModelError(f"unknown {kind} {shortened(name)}: one of {listed}{meant}")
    return known[name]


# How alike a name and a known one must be for the known one to be suggested.
_ALIKE = 0.8


def did_you_mean(name: object, known: Iterable[str]) -> str:
    """A clause that suggests the known name that a wrong one resembles; empty if none does.

    Examples
    --------
    >>> did_you_mean("MuJoCo", ["generic", "mujoco"]), did_you_mean("unreal", ["generic"])
    ('; did you mean mujoco?', '')
    >>> did_you_mean("hunt_crossley", ["hunt-crossley"])
    '; did you mean hunt-crossley?'
    """
    names = {each.replace("_", "-"): each for each in known}
    typed = str(name).casefold().replace("_", "-")
    close = difflib.get_close_matches(typed, names, n=1, cutoff=_ALIKE)
    return f"; did you mean {names[close[0]]}?" if close else ""


def suggesting(call: _Call) -> _Call:
    """A function or class that answers an unknown keyword argument with the one that it resembles.

    It is called with the settings of numpy with which it was tested, the default ones: a caller who
    makes numpy raise errors does so for code of his own.

    Examples
    --------
    >>> @suggesting
    ... def rise(*, restitution, height=1.0):
    ...     return restitution**2 * height
    >>> rise(restituton=0.5)
    Traceback (most recent call last):
    TypeError: rise() got an unexpected keyword argument 'restituton'; did you mean restitution?
    >>> rise(speed=2.0)
    Traceback (most recent call last):
    TypeError: rise() got an unexpected keyword argument 'speed': it has restitution and height
    """
    if not isinstance(call, type):
        return cast("_Call", _suggesting(call, call.__name__))
    kind: Any = call
    kind.__init__ = _suggesting(kind.__init__, call.__name__)
    return call


def _default_settings_of_numpy() -> AbstractContextManager:
    # What computes has imported numpy; what only reads arguments does not need it.
    numpy: Any = sys.modules.get("numpy")
    return numpy.errstate(all="warn", under="ignore") if numpy else nullcontext()


def _suggesting(call: Callable[..., Any], name: str) -> Callable[..., Any]:
    parameters = inspect.signature(call).parameters
    # A call that takes any keyword refuses unknown ones itself, as that of contact laws does.
    if any(each.kind is each.VAR_KEYWORD for each in parameters.values()):
        return call
    known = [each for each in parameters if each != "self"]

    @functools.wraps(call)
    def checked(*given: Any, **named: Any) -> Any:
        unknown = next((each for each in named if each not in known), None)
        if unknown is None:
            with _default_settings_of_numpy():
                return call(*given, **named)
        begins = [each for each in known if each.startswith(unknown)]
        meant = f"; did you mean {begins[0]}?" if len(begins) == 1 else ""
        *others, last = known
        has = f": it has {' and '.join(filter(None, [', '.join(others), last]))}"
        hint = meant or did_you_mean(unknown, known) or has
        raise TypeError(f"{name}() got an unexpected keyword argument {unknown!r}{hint}")

    return checked


def escaped(text: str) -> str:
    """Text with escapes for control characters and for marks that hide or reverse text.

    Examples
    --------
    >>> escaped("ϖ\\t= 2\\x1b[2J")
    'ϖ\\\\t= 2\\\\x1b[2J'
    """
    if text.isprintable():
        return text
    return "".join(
        c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text
    )


def printable(text: object, width: int | None = 300) -> str:
    """Text in one line, escaped as by :func:`escaped`; a longer text than ``width`` is cut off.

    Examples
    --------
    >>> printable("fig\\x1b[2J\\n\\u202e08\\udcff")
    'fig\\\\x1b[2J\\\\n\\\\u202e08\\\\udcff'
    >>> printable("Λ = 1 → 2, 1e-13", width=7)
    'Λ = 1 …'
    """
    text = str(text)
    return escaped(text if width is None or len(text) <= width else text[: width - 1] + "…")


def shortened(value: object) -> str:
    """A value as a message shows it: in one line, and cut off if it is long.

    Examples
    --------
    >>> shortened("x"), shortened([[1.0], [2.0, 3.0]])
    ("'x'", '[[1.0], [2.0, 3.0]]')
    >>> len(shortened(list(range(1000)))), shortened(10**5000)
    (80, 'a whole number of more than 4300 digits')
    """
    try:
        text = repr(value)
    # Python does not convert longer numbers to text.
    except ValueError:
        if isinstance(value, int):
            return f"a whole number of more than {sys.get_int_max_str_digits()} digits"
        return f"a {type(value).__name__}"
    return printable(" ".join(text.split()), _VALUE)


class Range(NamedTuple):
    """The range of the numbers allowed, as an annotation; ``ends`` are the interval's brackets.

    If ``or_zero`` is true, 0 is allowed beside the interval.

    Examples
    --------
    >>> print(Range(0, 1, "(]"), 0 in Range(0, 1, "(]"), 1 in Range(0, 1, "(]"))
    a number in (0, 1] False True
    >>> print(Range(0), "|", count(3), 2.5 in count(3), 10**400 in Range(0))
    a finite number > 0 | a whole number from 1 to 3 False False
    """

    low: float = -math.inf
    high: float = math.inf
    ends: str = "()"
    whole: bool = False
    or_zero: bool = False

    def __contains__(self, value: Any) -> bool:
        # A whole number may be larger than every float, and would not be converted.
        if not isinstance(value, int | float) or not abs(value) <= sys.float_info.max:
            return False
        if self.or_zero and value == 0:
            return True
        above = value > self.low if self.ends[0] == "(" else value >= self.low
        below = value < self.high if self.ends[1] == ")" else value <= self.high
        return above and below and (not self.whole or value == int(value))

    def __str__(self) -> str:
        if self.whole:
            return f"a whole number from {self.low:g} to {self.high:.0f}"
        if math.isinf(self.high):
            sign = ">" if self.ends[0] == "(" else "≥"
            return "a finite number" + ("" if math.isinf(self.low) else f" {sign} {self.low:g}")
        interval = f"a number in {self.interval}"
        return f"0 or {interval}" if self.or_zero else interval

    @property
    def interval(self) -> str:
        """The interval with its brackets, for example "(0, 1]"."""
        return f"{self.ends[0]}{self.low:g}, {self.high:g}{self.ends[1]}"


def count(high: int, low: int = 1) -> Range:
    """The range of the whole numbers from ``low`` to ``high``."""
    return Range(low, high, "[]", whole=True)


# The ranges of the arguments of public functions. Beyond these limits the squares of ϖ and Λ leave
# no digits, and a table that moves by less than the smallest Λ is at rest within the rounding of a
# flight.
FREQUENCY_RATIO = Range(1e-8, 1e8, "[]")
AMPLITUDE = Range(1e-12, 1e8, "[]", or_zero=True)
RESTITUTION = Range(0, 1, "(]")
RIGID_RESTITUTION = Range(0, 1, "[]")
"""The range of r of impacts that are instants; no contact with a spring and a damper has r = 0."""
DAMPING_RATIO = Range(0, 1, "[)")
FAMILY = count(1000)

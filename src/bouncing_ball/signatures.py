"""Ranges of a call's parameters, and parameters that it hands on to another call.

The command line reads both from the signatures of the calls, and the meaning of a parameter from
the call's docstring, so that each stands once.
"""

import inspect
import math
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Literal, NamedTuple, TypeVar, get_args, get_origin

from bouncing_ball.errors import ParameterError

_Call = TypeVar("_Call", bound=Callable)


class Range(NamedTuple):
    """The numbers that are allowed, as an annotation; ``ends`` are the brackets.

    Examples
    --------
    >>> print(Range(0, 1, "(]"), 0 in Range(0, 1, "(]"), 1 in Range(0, 1, "(]"))
    a number in (0, 1] False True
    >>> print(Range(0))
    a finite number > 0
    """

    low: float = -math.inf
    high: float = math.inf
    ends: str = "()"

    @property
    def whole(self) -> str:
        """The range as that of a whole number, in words."""
        return f"a whole number from {self.low:g} to {self.high:.0f}"

    def __contains__(self, value: Any) -> bool:
        above = value > self.low if self.ends[0] == "(" else value >= self.low
        below = value < self.high if self.ends[1] == ")" else value <= self.high
        return above and below and math.isfinite(value)

    def __str__(self) -> str:
        if math.isinf(self.high):
            return "a finite number" + ("" if math.isinf(self.low) else f" > {self.low:g}")
        return f"a number in {self.ends[0]}{self.low:g}, {self.high:g}{self.ends[1]}"


def takes(other: Callable, *names: str) -> Callable[[_Call], _Call]:
    """A call whose ``**keywords`` are parameters of another: its signature shows them.

    Parameters
    ----------
    other : callable
        The call to which the keywords are handed on.
    names : str
        Those of its parameters that are meant; all of them if none is named. A parameter of
        the decorated call without an annotation has that of the other, and its default.

    Examples
    --------
    >>> def area(length: float, width: float = 1.0): ...
    >>> @takes(area)
    ... def volume(height: float, *, length=2.0, **base): ...
    >>> print(inspect.signature(volume))
    (height: float, *, length: float = 2.0, width: float = 1.0)
    """
    others = inspect.signature(other).parameters

    def with_parameters(call: _Call) -> _Call:
        found = []
        for name, own in inspect.signature(call).parameters.items():
            if name in others and own.annotation is own.empty:
                default = others[name].default if own.default is own.empty else own.default
                own = others[name].replace(kind=own.kind, default=default)
            found += [own] if own.kind is not own.VAR_KEYWORD else []
        known = {own.name for own in found}
        more = [
            parameter.replace(kind=parameter.KEYWORD_ONLY)
            for name, parameter in others.items()
            if name not in known and (not names or name in names)
        ]
        call.__dict__["__signature__"] = inspect.Signature([*found, *more])
        call.__dict__["handed_on"] = other
        return call

    return with_parameters


def _entries(value: Any) -> list:
    """The entries of an array, a list or a labelled array; a single value is one entry."""
    value = getattr(value, "values", value)
    if hasattr(value, "ravel"):
        return value.ravel().tolist()
    return list(value) if isinstance(value, list | tuple) else [value]


def check(call: Callable, given: Mapping[str, Any]) -> None:
    """Raise :class:`ParameterError` unless each argument is one that the call's signature allows.

    For an array every entry must be allowed.

    Examples
    --------
    >>> def call(side: Literal["left", "right"], length: Annotated[Any, Range(0)] = 1.0): ...
    >>> check(call, {"length": [1.0, 2.0], "side": "up"})
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ParameterError: side = 'up' is not one of left, right
    >>> check(call, {"length": [1.0, -2.0]})
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ParameterError: length = -2.0 is not a finite number > 0
    """
    for name, parameter in inspect.signature(call).parameters.items():
        if given.get(name) is None:
            if name in given and parameter.default is parameter.empty:
                raise ParameterError(f"{{{name}}} is missing")
            continue
        for hint in (parameter.annotation, *get_args(parameter.annotation)):
            kind, *_, allowed = get_args(hint) or (None, None)
            if get_origin(hint) is Literal:
                _allow(
                    given[name] in get_args(hint),
                    name,
                    given[name],
                    "one of " + ", ".join(get_args(hint)),
                )
            elif get_origin(hint) is Annotated and isinstance(allowed, Range):
                entries = _entries(given[name])
                if not entries:
                    raise ParameterError(f"{{{name}}} has no entries")
                for value in entries:
                    whole = kind is int
                    good = (
                        isinstance(value, int | float)
                        and value in allowed
                        and (not whole or value == int(value))
                    )
                    _allow(good, name, value, allowed.whole if whole else str(allowed))


def _allow(good: bool, name: str, value: Any, allowed: str) -> None:
    if not good:
        raise ParameterError(f"{{{name}}} = {value!r} is not {allowed}")

"""Ranges of a call's parameters, and parameters that a call hands on to another call.

The command line takes both from the signatures of the calls, and the description of a parameter
from the docstring of the call, so that each is written once.
"""

import inspect
from collections.abc import Callable, Container, Mapping
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin

from bouncing_ball.errors import ParameterError, Range

_Call = TypeVar("_Call", bound=Callable)


def takes(other: Callable, *names: str, without: Container[str] = ()) -> Callable[[_Call], _Call]:
    """Decorator of a call that hands its ``**keywords`` on to another call.

    The signature of the decorated call shows the parameters of the other call.

    Parameters
    ----------
    other : callable
        The call to which the keywords are handed on.
    names : str
        The parameters of ``other`` that are handed on; all of them if none is named. A parameter
        of the decorated call without an annotation has the annotation of the other call and, if it
        has no default, the default of the other call.
    without : container of str
        Parameters of ``other`` that are not handed on.

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
        found = {}
        for name, own in inspect.signature(call).parameters.items():
            if name in others and own.annotation is own.empty:
                default = others[name].default if own.default is own.empty else own.default
                own = others[name].replace(kind=own.kind, default=default)
            if own.kind is not own.VAR_KEYWORD:
                found[name] = own
        for name, each in others.items():
            if (not names or name in names) and name not in without:
                found.setdefault(name, each.replace(kind=each.KEYWORD_ONLY))
        call.__dict__["__signature__"] = inspect.Signature(list(found.values()))
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
        value, hint = given.get(name), parameter.annotation
        if value is None:
            if name in given and parameter.default is parameter.empty:
                raise ParameterError(f"{{{name}}} is missing")
            continue
        for each in (hint, *get_args(hint)):
            if get_origin(each) is Literal:
                entries, allowed = [value], get_args(each)
                words = f"one of {', '.join(allowed)}"
            elif get_origin(each) is Annotated and isinstance(get_args(each)[-1], Range):
                entries, allowed = _entries(value), get_args(each)[-1]
                words = str(allowed)
            else:
                continue
            if not entries:
                raise ParameterError(f"{{{name}}} has no entries")
            for entry in entries:
                if entry not in allowed:
                    raise ParameterError(f"{{{name}}} = {{}} is not {words}", repr(entry))

"""Docstrings of calls that take the parameters of another call."""

import inspect
import re
from collections.abc import Callable
from typing import Any, TypeVar

C = TypeVar("C", bound=Callable[..., Any])

_SECTIONS = ("Parameters", "Returns", "Raises", "Examples")
_HEADING = re.compile(rf"\n\n({'|'.join(_SECTIONS)})\n-+\n")
# Names of parameters at the left margin, and the indented lines below them.
_ENTRY = re.compile(r"^(\w+(?:, \w+)*)(?: :.*)?(?:\n {4}.*)*", re.MULTILINE)


def as_in(*calls: Callable[..., Any]) -> Callable[[C], C]:
    """Complete the docstring of a call by what it shares with other calls.

    A parameter that the docstring does not describe is described as in the first of these calls
    that has it, and a section Returns or Raises that the docstring lacks is that of the first call.

    Examples
    --------
    >>> def fall(height, gravity):
    ...     '''Time of a fall.
    ...
    ...     Parameters
    ...     ----------
    ...     height : float
    ...         Height h.
    ...     gravity : float
    ...         Acceleration g.
    ...
    ...     Raises
    ...     ------
    ...     ValueError
    ...         If h < 0.
    ...     '''
    >>> @as_in(fall)
    ... def rise(speed, gravity):
    ...     '''Time of a rise.
    ...
    ...     Parameters
    ...     ----------
    ...     speed : float
    ...         Speed v.
    ...     '''
    >>> print(rise.__doc__)
    Time of a rise.
    <BLANKLINE>
    Parameters
    ----------
    speed : float
        Speed v.
    gravity : float
        Acceleration g.
    <BLANKLINE>
    Raises
    ------
    ValueError
        If h < 0.
    """

    def complete(call: C) -> C:
        summary, own = _sections(call)
        others = [_sections(each)[1] for each in calls]
        known: dict[str, str] = {}
        for sections in reversed([own, *others]):
            known |= _entries(sections)
        entries = [known[name] for name in inspect.signature(call).parameters if name in known]
        whole = others[0] | {"Examples": ""} | own
        whole["Parameters"] = "\n".join(dict.fromkeys(entries))
        parts = [
            f"{name}\n{'-' * len(name)}\n{whole[name]}" for name in _SECTIONS if whole.get(name)
        ]
        call.__doc__ = "\n\n".join([summary, *parts])
        return call

    return complete


def _sections(call: Callable[..., Any]) -> tuple[str, dict[str, str]]:
    """What a docstring says before its first section, and its sections by their names."""
    summary, *rest = _HEADING.split(inspect.getdoc(call) or "")
    return summary, dict(zip(rest[::2], (text.rstrip() for text in rest[1::2]), strict=True))


def _entries(sections: dict[str, str]) -> dict[str, str]:
    """The entry of each parameter; parameters that are described together share one."""
    found: dict[str, str] = {}
    for entry in _ENTRY.finditer(sections.get("Parameters", "")):
        found |= dict.fromkeys(entry[1].split(", "), entry[0].rstrip())
    return found

"""The output of the command line on streams of any encoding.

Characters that the encoding of the stream does not have are escaped. If the reader closes the pipe
(``| head``), the output ends without a message; if the device is full, it ends with one line.

Answers as text: values line by line, and a simulation as a table.
"""

import os
import sys
from contextlib import suppress
from typing import Any, NoReturn

from bouncing_ball_beyond.inherited.errors import printable


def fail(message: str, status: int) -> NoReturn:
    """Print one line on standard error and exit with the status."""
    with suppress(OSError):
        print(f"bouncing-ball: {printable(message, None)}", file=sys.stderr, flush=True)
    sys.exit(status)


def say(text: str) -> None:
    """Print a text.

    If the reader has closed the pipe, exit without a message; on another error exit with status 2.
    """
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    try:
        print(text.encode(encoding, "backslashreplace").decode(encoding), flush=True)
    except OSError as error:
        # Flushing the rest of the buffer would fail again at the interpreter's exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            fail(f"the output cannot be written: {error.strerror}", status=2)


def _value(value: Any) -> str:
    """A number with ten digits; other values as words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.10g}"
    return "none" if value is None else str(value)


def _rows(answer: dict[str, Any], prefix: str = "") -> list[str]:
    rows = []
    for key, value in answer.items():
        name = f"{prefix}{key.replace('_', ' ')}"
        if isinstance(value, dict):
            rows += _rows(value, f"{name}, ")
        elif key == "multipliers":
            shown = "   ".join(f"{re:.10g} {im:+.10g}i" for re, im in value)
            rows.append(f"{name:<39} {shown}")
        else:
            rows.append(f"{name:<39} {_value(value)}")
    return rows


def _columns(sequence: dict[str, list]) -> list[str]:
    """A heading, and one line for each impact of a simulation."""
    head = "".join(f"{name.replace('_', ' '):>24}" for name in sequence)
    body = [
        "".join(f"{'never' if value is None else format(value, '.12g'):>24}" for value in line)
        for line in zip(*sequence.values(), strict=True)
    ]
    return [head, *body]


def lines(answer: dict[str, Any]) -> list[str]:
    """The values line by line, several orbits one after another, and a simulation as a table.

    Examples
    --------
    >>> lines({"is_stable": True})
    ['is stable                               yes']
    """
    nested = ("orbits", "sequence")
    found = _rows({key: value for key, value in answer.items() if key not in nested})
    for index, orbit in enumerate(answer.get("orbits", []), start=1):
        found += ["", f"orbit {index}", *_rows(orbit)]
    return found + (_columns(answer["sequence"]) if "sequence" in answer else [])

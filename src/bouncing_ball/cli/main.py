"""Entry point of ``bouncing-ball``."""

import argparse
from collections.abc import Callable
from typing import Any

from bouncing_ball.cli.arguments import parse
from bouncing_ball.cli.output import fail, flush, prepare, print_lines, to_json
from bouncing_ball.errors import NoOrbitError


def _lines(answer: dict[str, Any], prefix: str = "") -> list[str]:
    """A readable table: one line for each value, ten digits."""
    lines = []
    for key, value in answer.items():
        name = f"{prefix}{key.replace('_', ' ')}"
        if isinstance(value, dict):
            lines += _lines(value, f"{name}, ")
        elif key == "multipliers":
            shown = "   ".join(f"{re:.10g} {im:+.10g}i" for re, im in value)
            lines.append(f"{name:<40}{shown}")
        elif isinstance(value, bool):
            lines.append(f"{name:<40}{'yes' if value else 'no'}")
        elif isinstance(value, float):
            lines.append(f"{name:<40}{value:.10g}")
        elif value is None:
            lines.append(f"{name:<40}none")
        else:
            lines.append(f"{name:<40}{value}")
    return lines


def _table(rows: dict[str, list]) -> list[str]:
    """Columns of a sequence, one line for each impact."""
    head = "".join(f"{name.replace('_', ' '):>24}" for name in rows)
    body = [
        "".join(f"{'never' if value is None else format(value, '.12g'):>24}" for value in line)
        for line in zip(*rows.values(), strict=True)
    ]
    return [head, *body]


def _readable(answer: dict[str, Any]) -> list[str]:
    """The values; all orbits one after another, or a simulation as a table."""
    nested = ("orbits", "sequence")
    lines = _lines({key: value for key, value in answer.items() if key not in nested})
    for index, orbit in enumerate(answer.get("orbits", []), start=1):
        lines += ["", f"orbit {index}", *_lines(orbit)]
    sequence = answer.get("sequence")
    return lines + (_table(sequence) if sequence else [])


def main(arguments: list[str] | None = None) -> None:
    """Answer one subcommand; exit 1 where there is no answer, 2 on a mistake.

    For ``diff`` see :mod:`bouncing_ball.cli.diff`.
    """
    prepare()
    try:
        _run(parse(arguments))
    finally:
        flush()


def _run(args: argparse.Namespace) -> None:
    if args.command == "diff":
        from bouncing_ball.cli import diff

        diff.run(args)
    try:
        others = {"explain": _explained, "design": _designed}
        answer, readable = others.get(args.command, _answered)(args)
    except ValueError as error:
        if args.json:
            print_lines([to_json({"error": str(error)})])
        fail(str(error), status=1 if isinstance(error, NoOrbitError) else 2)
    print_lines([to_json(answer)] if args.json else readable(answer))


Answered = tuple[dict[str, Any], Callable[[dict[str, Any]], list[str]]]
"""An answer, and the function that makes it readable."""

# Imports where they are needed: --help and a mistyped argument need no numpy.


def _answered(args: argparse.Namespace) -> Answered:
    """What the models say."""
    import numpy as np

    from bouncing_ball.cli import answers

    with np.errstate(all="ignore"):
        return getattr(answers, args.command.replace("-", "_"))(args), _readable


def _designed(args: argparse.Namespace) -> Answered:
    """What the calculator says of a contact."""
    import numpy as np

    from bouncing_ball.cli import design

    with np.errstate(all="ignore"):
        found = design.asked(args)
        if args.plot is not None:
            design.plot(found, args.plot)
    return design.answer(found), design.lines


def _explained(args: argparse.Namespace) -> Answered:
    """Where an artifact comes from."""
    from bouncing_ball.provenance.explain import explain, lines

    return explain(args.file), lines


if __name__ == "__main__":
    main()

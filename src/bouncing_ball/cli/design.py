"""``bouncing-ball design``: the calculator's answer, as JSON or to read."""

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

from bouncing_ball.accuracy.quantities import OF_IMPACTS, Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.calculator import design as calculator
from bouncing_ball.calculator.results import QUANTITIES, Design, Family, rows
from bouncing_ball.calculator.units import shown
from bouncing_ball.errors import ModelError
from bouncing_ball.signatures import takes

_DRAWINGS = (".pdf", ".png", ".svg")


def drawing(text: str) -> Path:
    """The file of a drawing, by its name.

    Raises
    ------
    argparse.ArgumentTypeError
        If the name ends otherwise.
    """
    path = Path(text)
    # Of the text too: a path forgets the slash that makes it a folder's.
    if path.suffix not in _DRAWINGS or not text.endswith(path.suffix):
        raise argparse.ArgumentTypeError(f"{text!r} does not end in {' or '.join(_DRAWINGS)}")
    return path


@takes(calculator.design)
def design(*, plot: Annotated[Path | None, drawing] = None, **given: Any) -> Design:
    """The calculator's answer, and the page to print.

    Parameters
    ----------
    plot
        A page to print: .pdf, .png or .svg.
    """
    found = calculator.design(**given)
    if plot is not None:
        _draw(found, plot)
    return found


def _draw(found: Design, path: Path) -> None:
    from bouncing_ball.calculator.page_data import page
    from bouncing_ball.figures.design_page import draw
    from bouncing_ball.figures.files import save
    from bouncing_ball.figures.style import style

    values = rows(found) + _orbit(found.judged)
    with style():
        figure = draw(asdict(found), page(found), values)
        try:
            save(figure, path, {"Title": "bouncing-ball design"})
        except OSError as error:
            raise ModelError(f"{path} cannot be written: {error.strerror}") from None


def _orbit(one: Family) -> list[tuple[str, str]]:
    """Lengths, times and forces of the orbit of the contact, if there is one."""
    return rows(one) if one.exists else []


def _line(name: str, *columns: str) -> str:
    return f"{name:<38}" + "".join(f"{column:<18}" for column in columns).rstrip()


def _error(one: Family, quantity: Quantity) -> str:
    errors = (of[quantity] for of in (one.errors, one.law_errors, one.corrected_errors))
    return _line(f"    {QUANTITIES[quantity]}", *(shown(error, "%") for error in errors))


def _family_lines(one: Family) -> list[str]:
    lines = ["", f"{one.n}-T orbit", _line("", *one.standing)]
    for columns in zip(*map(rows, one.standing.values()), strict=True):
        lines.append(_line(f"  {columns[0][0]}", *(text for _, text in columns)))
    lines += [_line(f"  {name}", text) for name, text in _orbit(one)]
    holds = "error law" if one.law_holds else "law, not stated"
    lines.append(_line("  relative error", "restitution", holds, "corrected"))
    return lines + [_error(one, quantity) for quantity in OF_IMPACTS]


def lines(found: Design) -> list[str]:
    """The answer to read, the verdict first."""
    need = found.needed

    def threshold(value: float | None, status: str) -> str:
        return "any" if status == ThresholdStatus.ALWAYS_WITHIN else shown(value)

    simple = "error law", "corrected"
    asked = f"ϖ for {shown(need.tolerance, '%')} in the {QUANTITIES[Quantity(need.quantity)]}"
    ratios = (
        threshold(need.frequency_ratio, need.status),
        shown(need.by_law),
        threshold(need.corrected, need.corrected_status),
    )
    return [
        found.verdict,
        f"Reason: {found.reason}.",
        *(f"Note: {note}." for note in found.notes),
        "",
        *(_line(*row) for row in rows(found)),
        f"Time step: {found.time_step.rule}.",
        "",
        _line(asked, "exact", *simple),
        _line("", *ratios),
        *(line for one in found.orbits for line in _family_lines(one)),
        "",
        # That of the permanent contact is the same in all families.
        _line("relative error", "restitution", *simple),
        _error(found.orbits[0], Quantity.PERMANENT_CONTACT),
    ]

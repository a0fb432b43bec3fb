"""``bouncing-ball design``: the calculator's answer, as JSON or to read."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

from bouncing_ball.accuracy.quantities import OF_IMPACTS, Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.calculator import design as calculator
from bouncing_ball.calculator.results import QUANTITIES, Design, Family, rows
from bouncing_ball.calculator.units import shown
from bouncing_ball.errors import ModelError
from bouncing_ball.signatures import takes

_DRAWINGS = (".pdf", ".png", ".svg")


@takes(calculator.design)
def design(*, plot: Path | None = None, **given: Any) -> Design:
    """The calculator's answer, and the page to print.

    Parameters
    ----------
    plot
        A page to print: .pdf, .png or .svg.

    Raises
    ------
    ModelError
        If the page has another name or cannot be written.
    """
    if plot is not None and plot.suffix not in _DRAWINGS:
        raise ModelError(f"'{plot}' does not end in {' or '.join(_DRAWINGS)}")
    found = calculator.design(**given)
    if plot is not None:
        _draw(found, plot)
    return found


def _draw(found: Design, path: Path) -> None:
    from bouncing_ball.calculator.page_data import page
    from bouncing_ball.figures.design_page import draw
    from bouncing_ball.figures.files import save
    from bouncing_ball.figures.style import style

    with style():
        figure = draw(asdict(found), page(found), rows(found) + rows(found.judged))
        try:
            save(figure, path, {"Title": "bouncing-ball design"})
        except OSError as error:
            raise ModelError(f"{path} cannot be written: {error.strerror}") from None


def _line(name: str, *columns: str) -> str:
    return f"{name:<38}" + "".join(f"{column:<18}" for column in columns).rstrip()


def _error(one: Family, quantity: Quantity) -> str:
    errors = (of[quantity] for of in (one.errors, one.law_errors, one.corrected_errors))
    return _line(f"    {QUANTITIES[quantity]}", *(shown(error, "%") for error in errors))


def _family_lines(one: Family) -> list[str]:
    lines = ["", f"{one.n}-T orbit", _line("", *one.standing)]
    for columns in zip(*map(rows, one.standing.values()), strict=True):
        lines.append(_line(f"  {columns[0][0]}", *(text for _, text in columns)))
    if one.exists:
        lines += [_line(f"  {name}", text) for name, text in rows(one)]
    holds = "error law" if one.law_holds else "law, not stated"
    lines.append(_line("  relative error", "restitution", holds, "corrected"))
    return lines + [_error(one, quantity) for quantity in OF_IMPACTS]


def lines(found: Design) -> list[str]:
    """The answer to read, the verdict first."""
    need, always = found.needed, ThresholdStatus.ALWAYS_WITHIN
    simple = "error law", "corrected"
    asked = f"ϖ for {shown(need.tolerance, '%')} in the {QUANTITIES[Quantity(need.quantity)]}"
    exact = "any" if need.status == always else shown(need.frequency_ratio)
    corrected = "any" if need.corrected_status == always else shown(need.corrected)
    return [
        found.verdict,
        f"Reason: {found.reason}.",
        *(f"Note: {note}." for note in found.notes),
        "",
        *(_line(*row) for row in rows(found)),
        f"Time step: {found.time_step.rule}.",
        "",
        _line(asked, "exact", *simple),
        _line("", exact, shown(need.by_law), corrected),
        *(line for one in found.orbits for line in _family_lines(one)),
        "",
        # That of the permanent contact is the same in all families.
        _line("relative error", "restitution", *simple),
        _error(found.orbits[0], Quantity.PERMANENT_CONTACT),
    ]

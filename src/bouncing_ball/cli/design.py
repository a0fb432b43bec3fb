"""``bouncing-ball design``: the calculator's answer, as JSON or to read."""

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

from bouncing_ball.accuracy.quantities import Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.calculator import design as calculator
from bouncing_ball.calculator.design import Design
from bouncing_ball.calculator.units import shown
from bouncing_ball.calculator.verdict import QUANTITIES, percent
from bouncing_ball.errors import ModelError
from bouncing_ball.signatures import takes

Answer = dict[str, Any]
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
def design(*, plot: Annotated[Path | None, drawing] = None, **given: Any) -> Answer:
    """The calculator's answer, and the page to print.

    Parameters
    ----------
    plot
        A page to print: .pdf, .png or .svg.
    """
    found = calculator.design(**given)
    if plot is not None:
        _draw(found, plot)
    return asdict(found)


def _draw(found: Design, path: Path) -> None:
    from bouncing_ball.calculator.page_data import page
    from bouncing_ball.figures.design_page import draw
    from bouncing_ball.figures.files import save
    from bouncing_ball.figures.style import style

    said = asdict(found)
    judged = next(one for one in said["orbits"] if one["n"] == said["n"])
    with style():
        figure = draw(said, page(found), _contact_values(said) + _orbit_values(judged))
        try:
            save(figure, path, {"Title": "bouncing-ball design"})
        except OSError as error:
            raise ModelError(f"{path} cannot be written: {error.strerror}") from None


def _row(name: str, *columns: str) -> str:
    return f"{name:<38}" + "".join(f"{column:<18}" for column in columns).rstrip()


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.4g}"


def _share(value: float | None) -> str:
    return "none" if value is None else percent(value)


def _threshold(value: float | None, status: str) -> str:
    return "any" if status == ThresholdStatus.ALWAYS_WITHIN else _number(value)


def _contact_values(found: Answer) -> list[tuple[str, str]]:
    """What is known of the contact, by name."""
    both, three = found["restitution"], found["corrected"]
    down = found["permanent_contact"]
    return [
        ("frequency ratio ϖ", _number(found["frequency_ratio"])),
        ("damping ratio ζ", _number(found["damping_ratio"])),
        ("excitation amplitude Λ", _number(found["amplitude"])),
        ("stiffness", shown(found["stiffness"], "N/m")),
        ("damping", shown(found["damping"], "N s/m")),
        ("contact time", shown(found["contact_time"], "s")),
        ("largest time step", shown(found["time_step"]["largest"], "s")),
        ("static deflection", shown(found["static_deflection"], "m")),
        ("restitution, released at δ = 0", _number(both["displacement"])),
        ("restitution, released without force", _number(both["force"])),
        ("permanent contact up to Λ", _number(down["threshold"])),
        ("  in the restitution model", _number(down["restitution_threshold"])),
        ("corrected model, delay t_c", shown(three["delay"], "s")),
        ("corrected model, restitution r", _number(three["restitution"])),
        ("corrected model, load σ", shown(three["load"], "s")),
    ]


def _orbit_values(one: Answer) -> list[tuple[str, str]]:
    """Lengths, times and forces of the orbit of the contact, by name."""
    if not one["exists"]:
        return []
    return [
        ("greatest height", shown(one["max_height"], "m")),
        ("impact speed", shown(one["impact_speed"], "m/s")),
        ("duration of contact", shown(one["contact_duration"], "s")),
        ("greatest compression", shown(one["greatest_compression"], "m")),
        ("peak force", shown(one["peak_force"], "N")),
        ("peak force over weight", _number(one["peak_force_over_weight"])),
    ]


def _family_lines(one: Answer) -> list[str]:
    lines = ["", f"{one['n']}-T orbit", _row("", *one["standing"])]

    def across(name: str, show) -> str:
        return _row(f"  {name}", *(show(standing) for standing in one["standing"].values()))

    lines += [
        across("exists", lambda s: "yes" if s["exists"] else "no"),
        across("stable", lambda s: "yes" if s["is_stable"] else "no"),
        across("saddle-node at Λ", lambda s: _number(s["saddle_node"])),
        across("  Λ may fall by", lambda s: _share(s["saddle_node_margin"])),
        across("period doubling at Λ", lambda s: _number(s["period_doubling"])),
        across("  Λ may rise by", lambda s: _share(s["period_doubling_margin"])),
    ]
    lines += [_row(f"  {name}", value) for name, value in _orbit_values(one)]
    holds = "error law" if one["law_holds"] else "law, not stated"
    lines.append(_row("  relative error", "restitution", holds, "corrected"))
    of_impacts = [name for name in QUANTITIES if name != Quantity.PERMANENT_CONTACT]
    return lines + [_error(one, name) for name in of_impacts]


def _error(one: Answer, name: str) -> str:
    errors = (one[key][name] for key in ("errors", "law_errors", "corrected_errors"))
    return _row(f"    {QUANTITIES[Quantity(name)]}", *map(_share, errors))


def lines(found: Answer) -> list[str]:
    """The answer to read, the verdict first."""
    need = found["needed"]
    shown = [found["verdict"], f"Reason: {found['reason']}."]
    shown += [f"Note: {note}." for note in found["notes"]]
    shown += ["", *(_row(name, value) for name, value in _contact_values(found))]
    shown += [f"Time step: {found['time_step']['rule']}.", ""]
    name = QUANTITIES[need["quantity"]]
    shown += [
        _row(
            f"ϖ for {percent(need['tolerance'])} in the {name}", "exact", "error law", "corrected"
        ),
        _row(
            "",
            _threshold(need["frequency_ratio"], need["status"]),
            _number(need["by_law"]),
            _threshold(need["corrected"], need["corrected_status"]),
        ),
    ]
    for one in found["orbits"]:
        shown += _family_lines(one)
    # That of the permanent contact is the same in all families.
    head = _row("relative error", "restitution", "error law", "corrected")
    return [*shown, "", head, _error(found["orbits"][0], Quantity.PERMANENT_CONTACT)]

"""``bouncing-ball design``: the calculator's answer, as JSON or to read."""

import argparse
import math
from dataclasses import fields, is_dataclass
from typing import Any

from bouncing_ball.calculator.calls import design
from bouncing_ball.calculator.design import Design
from bouncing_ball.calculator.units import KINDS
from bouncing_ball.calculator.verdict import QUANTITIES, percent

Answer = dict[str, Any]

_PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n"}


def asked(args: argparse.Namespace) -> Design:
    """The calculator's answer to what was asked.

    Raises
    ------
    ModelError, NoOrbitError
        As :func:`~bouncing_ball.calculator.calls.design`.
    """
    names = (*KINDS, "n", "release", "quantity")
    return design(**{name: getattr(args, name) for name in names})


def answer(found: Design) -> Answer:
    """All of it as plain values, what is not finite as null."""
    return _plain(found)


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}
    if isinstance(value, dict):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return str(value) if isinstance(value, str) else value


def quantity(value: float | None, unit: str) -> str:
    """A value with a prefix of its unit, four digits.

    Examples
    --------
    >>> quantity(1.25e-5, "s"), quantity(2e7, "N/m"), quantity(None, "m")
    ('12.5 µs', '20 MN/m', 'none')
    """
    if value is None:
        return "none"
    if value == 0:
        return f"0 {unit}"
    power = min(9, max(-9, 3 * math.floor(math.log10(abs(float(f"{value:.4g}"))) / 3)))
    return f"{value / 10**power:.4g} {_PREFIXES[power]}{unit}"


def _row(name: str, *columns: str) -> str:
    return f"{name:<38}" + "".join(f"{column:<18}" for column in columns).rstrip()


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.4g}"


def _share(value: float | None) -> str:
    return "none" if value is None else percent(value)


def _contact_lines(found: Answer) -> list[str]:
    both, three = found["restitution"], found["corrected"]
    down = found["permanent_contact"]
    return [
        _row("frequency ratio ϖ", _number(found["frequency_ratio"])),
        _row("damping ratio ζ", _number(found["damping_ratio"])),
        _row("excitation amplitude Λ", _number(found["amplitude"])),
        "",
        _row("stiffness", quantity(found["stiffness"], "N/m")),
        _row("damping", quantity(found["damping"], "N s/m")),
        _row("contact time", quantity(found["contact_time"], "s")),
        _row("largest time step", quantity(found["time_step"]["largest"], "s")),
        f"  {found['time_step']['rule']}",
        _row("static deflection", quantity(found["static_deflection"], "m")),
        _row("restitution, released at δ = 0", _number(both["displacement"])),
        _row("restitution, released without force", _number(both["force"])),
        _row(
            "permanent contact up to Λ",
            _number(down["threshold"]),
            f"(restitution model: {_number(down['restitution_threshold'])})",
        ),
        _row("corrected model, delay t_c", quantity(three["delay"], "s")),
        _row("corrected model, restitution r", _number(three["restitution"])),
        _row("corrected model, load σ", quantity(three["load"], "s")),
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
    if one["exists"]:
        lines += [
            _row("  greatest height", quantity(one["max_height"], "m")),
            _row("  impact speed", quantity(one["impact_speed"], "m/s")),
            _row("  duration of contact", quantity(one["contact_duration"], "s")),
            _row("  greatest compression", quantity(one["greatest_compression"], "m")),
            _row(
                "  peak force",
                quantity(one["peak_force"], "N"),
                f"{_number(one['peak_force_over_weight'])} times the weight",
            ),
        ]
    holds = "error law" if one["law_holds"] else "law, not stated"
    lines.append(_row("  relative error", "restitution", holds, "corrected"))
    lines += [
        _row(
            f"    {words}",
            _share(one["errors"][name]),
            _share(one["law_errors"][name]),
            _share(one["corrected_errors"][name]),
        )
        for name, words in QUANTITIES.items()
    ]
    return lines


def lines(found: Answer) -> list[str]:
    """The answer to read, the verdict first."""
    need = found["needed"]
    shown = [found["verdict"], f"Reason: {found['reason']}."]
    shown += [f"Note: {note}." for note in found["notes"]]
    shown += ["", *_contact_lines(found)]
    name = QUANTITIES[need["quantity"]]
    shown += [
        _row(
            f"ϖ for {percent(need['tolerance'])} in the {name}", "exact", "error law", "corrected"
        ),
        _row("", *(_number(need[key]) for key in ("frequency_ratio", "by_law", "corrected"))),
    ]
    for one in found["orbits"]:
        shown += _family_lines(one)
    return shown

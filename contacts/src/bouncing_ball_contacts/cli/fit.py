"""``bouncing-ball fit``: the contact laws that are fitted to a file of measured impacts."""

from pathlib import Path
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError, did_you_mean
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts.cli.design import answer_design, design_document
from bouncing_ball_contacts.cli.design_answer import DesignAnswer
from bouncing_ball_contacts.cli.design_text import design_lines
from bouncing_ball_contacts.contact.quantities import Speed, quantities
from bouncing_ball_contacts.contact.table import Table
from bouncing_ball_contacts.contact.texts import lines
from bouncing_ball_contacts.contact.units import doubts, in_si
from bouncing_ball_contacts.measured.experiment import (
    QUANTITIES,
    Experiment,
    experiment,
    experiment_names,
    read,
)
from bouncing_ball_contacts.measured.law_fit import LawFit, orbit_speed
from bouncing_ball_contacts.measured.verdicts import (
    JudgedLaw,
    RestitutionAtSpeed,
    error_size,
    judge,
    restitution_at_speed,
)

# In SI units the unit of time is a second, and ϖ is a natural frequency.
_SHOWN = {"frequency_ratio": "natural frequency"}


class _At:
    """The quantity of the option ``speed``."""

    speed: Speed


def fit(
    file: str,
    /,
    *,
    intervals: bool = False,
    mass: str | None = None,
    diameter: str | None = None,
    contact_time: str | None = None,
    contact_time_uncertainty: str | None = None,
    resolution: str | None = None,
    speed: str | None = None,
    frequency: str | None = None,
    leave_out: str | None = None,
    engine: str | None = None,
    time_step: str | None = None,
    script: Path | None = None,
) -> dict[str, Any]:
    """The laws fitted to a file, ranked, with verdicts, as values for JSON.

    Parameters
    ----------
    file
        File of measured impacts, or the name of an experiment of the package.
    intervals
        The file has the intervals between the impacts of one bouncing ball, one on each line.
    mass
        Mass of the ball, such as "20 g".
    diameter
        Diameter of the ball; with the mass, the drag of the air is removed.
    contact_time
        Duration of a contact; without one no stiffness is identified.
    contact_time_uncertainty
        Standard deviation of the contact time.
    resolution
        Standard deviation of the times of impacts, for intervals.
    speed
        Impact speed of the contact for "design"; by default the middle of the measured speeds.
    frequency
        Frequency of a table, in place of the speed: that of its 1-T orbit.
    leave_out
        Line of the file that is left out, or several, such as 4,7.
    engine
        Physics engine for which the contact is written; the answer then begins with the recipe.
    time_step
        The engine's time step, if it is given; without a contact time the contact suits it.
    script
        File for a script in Python that drops the ball in the engine.

    Raises
    ------
    ModelError
        If the file or an option is not understood.
    """
    if speed is not None and frequency is not None:
        raise ParameterError("{speed} and {frequency} each give the impact speed: give one")
    options = {
        "mass": mass,
        "diameter": diameter,
        "contact_time": contact_time,
        "contact_time_uncertainty": contact_time_uncertainty,
        "resolution": resolution,
    }
    found = _experiment(file, intervals=intervals, leave_out=_lines(leave_out), **options)
    fitted = found.fit()
    judged = judge(fitted)
    best = fitted.best

    def used(speed: float) -> float:
        return restitution_at_speed(fitted, judged, speed).restitution

    if frequency is not None:
        # The impact speed of an orbit is the same at every amplitude.
        v = orbit_speed(Table(frequency=frequency, acceleration="1 g"), used)
    elif speed is not None:
        v = in_si("speed", speed, quantities(_At)["speed"])
    else:
        v = best.speed
    at_speed = restitution_at_speed(fitted, judged, v)
    recipe = None
    if engine is not None:
        recipe = _recipe(best, v, at_speed.restitution, engine, time_step, script)
    elif time_step is not None or script is not None:
        name = "time_step" if script is None else "script"
        raise ParameterError(f"{{{name}}} needs {{engine}}, such as mujoco")
    kinds = {name.replace(" ", "_"): kind for name, kind in QUANTITIES.items()} | quantities(_At)
    of_law = (
        f'{_design(best, v, float(best.restitution_at(v)))} --law {best.law} --speed "{v:.6g} m/s"'
    )
    doubted = doubts(options | {"speed": speed}, kinds)
    return {
        "recipe": recipe,
        "experiment": found.title,
        "points": fitted.points.size,
        "slowest": float(fitted.points.speeds.min()),
        "fastest": float(fitted.points.speeds.max()),
        "reference_speed": best.speed,
        "speed": v,
        "restitution": at_speed.restitution,
        "restitution_interval": [_number(x) for x in at_speed.interval],
        "no_law_fits": _no_law_fits(at_speed, v, fitted.points.is_known),
        "impacts": _impacts(found),
        "errors_given": fitted.points.is_known,
        "errors_size": _number(error_size(fitted.points)),
        "laws": [_law(each, judged[each.law]) for each in fitted.laws],
        "curves": [list(names) for names in fitted.curves],
        "notes": lines("fit_notes", found=found, fitted=fitted, speed=v, doubts=doubted),
        "design": _design(best, v, at_speed.restitution),
        "design_of_law": None if best.law == SpringDamper.name else of_law,
    }


def _recipe(
    best: LawFit,
    speed: float,
    restitution: float,
    engine: str,
    time_step: str | None,
    script: Path | None,
) -> DesignAnswer:
    """The contact with a restitution coefficient and the contact time of the law at an impact
    speed, as it is written for an engine.
    """
    if best.mass is None:
        raise ParameterError("{engine} needs {mass}, such as 20 g")
    contact = {
        "mass": best.mass,
        "contact_time": _typed(best.duration_at(speed)) if best.has_stiffness else None,
        "measured_restitution": _typed(restitution),
    }
    setup = {"speed": _typed(speed), "engine": engine, "time_step": time_step}
    return answer_design(contact | setup, script)._replace(whole=False)


def _typed(value: Any) -> float:
    """A number with the six digits of the commands that are printed."""
    return float(f"{float(value):.6g}")


def _lines(text: str | None) -> list[int]:
    """The numbers of lines."""
    parts = [] if text is None else text.replace(",", " ").split()
    if not all(part.isdecimal() for part in parts):
        raise ParameterError("{leave_out} = {} is not a list of lines, such as 4,7", text)
    return [int(part) for part in parts]


def _experiment(file: str, *, intervals: bool, **options: Any) -> Experiment:
    known = file in experiment_names() and not Path(file).exists()
    if known and not intervals and not any(options.values()):
        return experiment(file)
    from bouncing_ball_contacts.measured.experiment import DATA

    if not known and not Path(file).exists():
        of = ", ".join(experiment_names())
        said = f"is neither a file nor an experiment of the package: {of}"
        raise ModelError(f"{file} {said}{did_you_mean(file, experiment_names())}")
    return read(DATA / f"{file}.csv" if known else file, intervals=intervals, **options)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _impacts(found: Experiment) -> list[dict[str, float]]:
    """The impacts of a bouncing ball with the biases that were removed; empty for other files."""
    heard = found.heard
    if heard is None:
        return []
    columns = {
        "speed": heard.speeds,
        "restitution": heard.restitutions,
        "ratio_of_intervals": heard.ratios,
        "drag_bias": heard.drag_bias,
        "resolution_bias": heard.resolution_bias,
    }
    return [
        dict(zip(columns, map(float, row), strict=True))
        for row in zip(*columns.values(), strict=True)
    ]


def _law(fitted: LawFit, judgement: JudgedLaw) -> dict[str, Any]:
    return {
        "law": fitted.law,
        "verdict": str(judgement.verdict),
        "errors_needed": _number(judgement.needed),
        "restitution": fitted.restitution,
        "restitution_interval": [_number(x) for x in judgement.interval],
        "rms": fitted.rms,
        "left_out_rms": _number(fitted.left_out),
        "extrapolation_rms": _number(judgement.extrapolation),
        "chi_square_probability": _number(fitted.p_value),
        "left_out_probability": _number(judgement.left_out),
        "extrapolation_probability": _number(judgement.extrapolated),
        "akaike": _number(fitted.criterion),
        "contact_time": _number(fitted.contact_time),
        "contact_time_interval": [_number(x) for x in fitted.time_interval],
        "parameters": fitted.parameters() if fitted.has_stiffness else None,
        "units": fitted.units,
    }


def _no_law_fits(found: RestitutionAtSpeed, speed: float, is_known: bool) -> str | None:
    """A sentence on the restitution coefficient that is used where the points reject all laws."""
    if found.is_of_a_law_that_fits:
        return None
    interval = _interval([_number(x) for x in found.interval], 1, "{:.4f}")
    used = f"e = {found.restitution:.4f} (95 % {interval}) at {speed:.3g} m/s is that of"
    if found.law is None:
        source = "a smooth curve through the points, a parabola in ln v"
    else:
        source = f"{found.law}, with the smallest rms, and its interval by the scatter about it"
    size = "their uncertainties allow" if is_known else "they scatter"
    return f"No law fits: each is further from the points than {size}. {used} {source}."


def _design(best: LawFit, speed: float, restitution: float) -> str:
    """The command for the linear contact with a restitution coefficient and the contact time of the
    law at an impact speed; what is not known stands there in capitals.
    """
    mass = "MASS" if best.mass is None else f'"{best.mass:.6g} kg"'
    time = f'"{float(best.duration_at(speed)):.6g} s"' if best.has_stiffness else "TIME"
    return (
        f"bouncing-ball design --mass {mass} --contact-time {time} "
        f"--measured-restitution {restitution:.6g}"
    )


def fit_document(answer: dict[str, Any]) -> dict[str, Any]:
    """The answer as plain values for JSON."""
    recipe = answer["recipe"]
    rest = {name: value for name, value in answer.items() if name != "recipe"}
    return rest if recipe is None else rest | {"recipe": design_document(recipe)}


def fit_lines(answer: dict[str, Any]) -> list[str]:
    """The answer as text: the impacts that were heard, the laws, notes and the next command."""
    recipe = answer["recipe"]
    tables = []
    if answer["impacts"]:
        head = "v in m/s", "e", "ratio", "by drag", "by resolution"
        tables += [*_table(head, [_impact(row) for row in answer["impacts"]]), ""]
    at = f"e at {answer['reference_speed']:.3g} m/s"
    head = "law", at, "95 %", "rms", "left out", "errors needed", "verdict"
    laws = [
        _judged(names, next(law for law in answer["laws"] if law["law"] == names[0]))
        for names in answer["curves"]
    ]
    tables += [*_table(head, laws), ""]
    if timed := [_timed(law) for law in answer["laws"] if law["contact_time"] is not None]:
        tables += [*_table(("law", "contact time in ms", "95 %", "parameters"), timed), ""]
    before = [] if recipe is None else [*design_lines(recipe), ""]
    return lines("fit", **(answer | {"recipe": before, "tables": tables}))


def _impact(row: dict[str, float]) -> list[str]:
    """An impact that was heard; what was removed from its e may be small, and has two digits."""
    biases = [f"{row[name]:.2g}" for name in ("drag_bias", "resolution_bias")]
    kept = [f"{row[name]:.5f}" for name in ("speed", "restitution", "ratio_of_intervals")]
    return [*kept, *biases]


def _judged(names: list[str], law: dict[str, Any]) -> list[str]:
    """The row of laws with one r(v), by the numbers of the first of them."""
    return [
        ", ".join(names),
        f"{law['restitution']:.4f}",
        _interval(law["restitution_interval"], 1, "{:.4f}"),
        f"{law['rms']:.4f}",
        _shown(law["left_out_rms"]),
        _shown(law["errors_needed"]),
        law["verdict"],
    ]


def _shown(value: float | None) -> str:
    return "-" if value is None else f"{value:.4f}"


def _timed(law: dict[str, Any]) -> list[str]:
    numbers = ", ".join(
        f"{_SHOWN.get(name, name)} {value:.6g} {law['units'][name]}".rstrip()
        for name, value in law["parameters"].items()
    )
    time = f"{law['contact_time'] * 1e3:.4g}"
    interval = _interval(law["contact_time_interval"], 1e3, "{:.3g}")
    return [law["law"], time, interval, numbers.replace("_", " ")]


def _interval(ends: list[float | None], unit: float, digits: str) -> str:
    if None in ends:
        return "-"
    return " to ".join(digits.format(unit * end) for end in ends if end is not None)


def _table(head: tuple[str, ...], rows: list[list[str]]) -> list[str]:
    """Columns of equal width, two spaces apart."""
    widths = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in (head, *rows)
    ]

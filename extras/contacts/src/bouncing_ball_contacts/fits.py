"""The answer to a recording: r at a speed with its interval, and what else is known of it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bouncing_ball_contacts.bounces import Bounce, Quantity
from bouncing_ball_contacts.cameras import KINK
from bouncing_ball_contacts.flights import drag_of
from bouncing_ball_contacts.intervals import (
    KINDS,
    Impacts,
    curves_of,
    estimate,
    impacts_of,
    misread,
    without_contacts,
)
from bouncing_ball_contacts.recordings import Recording, read, rounding_of
from bouncing_ball_contacts.units import (
    MOST_WARNINGS,
    STANDARD_GRAVITY,
    Refused,
    holding,
    positive,
    refuse,
    show,
    span,
)

_WITH_DRAG = ("flights", "heights", "drops", "track")
# Mass in kg and diameter in m of a ball that the drag changes much.
_TABLE_TENNIS_BALL = (0.0027, 0.040)
# Contact in s by which r changes as by a longer one.
_SHORT_CONTACT = 1e-4
# Speed in m/s at which the picture of a ball seldom drifts.
_DRIFT = 0.1


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """Restitution coefficient of a recording at a speed.

    Attributes
    ----------
    recording, impacts
        What was measured, and the impacts of it.
    speed
        Speed in m/s of the restitution coefficient; NaN if no speed is known.
    restitution, interval
        Restitution coefficient, and both ends of its 95 % interval.
    scatter
        Root mean square of the deviations of single impacts from the curve, or those of the means
        of three groups or more.
    slope
        Exponent of the speed in r; NaN if the speeds differ by no more than their errors.
    contact_time
        In s; 0 if it is not known.
    mass, diameter
        Of the ball in kg and m; None if they are not known.
    notes
        What a user has to know, the severest first.
    """

    recording: Recording
    impacts: Impacts
    speed: float
    restitution: float
    interval: tuple[float, float]
    scatter: float
    slope: float
    contact_time: float
    mass: float | None
    diameter: float | None
    notes: tuple[str, ...]

    @property
    def result(self) -> str:
        """The title, and r with its interval."""
        title = self.recording.head.get("title", self.recording.name)
        ends = span(*self.interval, 4)
        # r has the digits of its interval, in which it would not lie with fewer.
        r = f"{self.restitution:.{len(ends.split()[0]) - 2}f}"
        at = "" if math.isnan(self.speed) else f" at {self.speed:.3g} m/s"
        return f"{title}: r = {r} ({ends}){at}"

    @property
    def _groups(self) -> int:
        """Number of groups of several impacts."""
        _, counts = np.unique(self.impacts.groups, return_counts=True)
        return int(np.sum(counts > 1))

    def _lines(self, most: int) -> list[str]:
        v = self.impacts.speed
        groups = self._groups
        deviate = f"means of {groups} groups" if groups > 2 else "single impacts"
        count = "1 impact" if len(v) == 1 else f"{len(v)} impacts"
        slope = self.slope
        said = [
            (
                math.isnan(slope) and v.max() > v.min(),
                "r is taken as constant"
                if groups > 2
                else "the speeds differ by no more than their errors",
            ),
            (not math.isnan(slope), f"r goes as v^{slope:+.3f}"),
            (len(v) > 1, f"{deviate} deviate by {self.scatter:.4f}"),
        ]
        speeds = span(v.min(), v.max(), form="g") if v.max() > v.min() else f"{v[0]:.3g}"
        more = "; ".join([f"from {self.recording.kind}", *filter(None, [", ".join(holding(said))])])
        return [
            self.result,
            f"{count}{'' if self.recording.no_speed else f' at {speeds} m/s'}, {more}",
            *(f"! {note}" for note in self.notes[:most]),
        ]

    @property
    def explained(self) -> str:
        """All of the answer."""
        return "\n".join(self._lines(len(self.notes)))

    def __str__(self) -> str:
        lines = self._lines(MOST_WARNINGS)
        count = len(self.notes) - MOST_WARNINGS
        named = "1 more remark" if count == 1 else f"{count} more remarks"
        return "\n".join([*lines, *holding([(count > 0, f"{named}: --explain")])])

    __repr__ = __str__

    def bounce(self, is_spring: bool = True, **given: Quantity) -> Bounce:
        """Return the bounce at this speed; of a spring also its contact time, if it was read.

        The contact time of a bounce is the one of a linear contact without damping.
        """
        refuse([(self.recording.no_speed, f"no speed is known: {self.recording.no_speed}")])
        body = {"restitution": self.restitution, "speed": self.speed, "mass": self.mass, **given}
        if self.diameter is not None and not given.keys() & {"radius", "density"}:
            body["radius"] = self.diameter / 2
        is_given = given.keys() & {"penetration", "stiffness", "contact_time"}
        if self.contact_time and is_spring and not is_given:
            # √(k/m) times the contact time, which would be π without damping.
            body["contact_time"] = math.pi * self.contact_time / _phase(self.restitution)
        return Bounce(**body)


def _phase(restitution: float) -> float:
    """Return √(k/m) times the contact time of a spring and a damper that never pull.

    With the damping ratio ζ it is 2 arccos(ζ)/√(1 - ζ²), and r = exp(-ζ times it).
    """
    ratios = np.geomspace(1e-6, 1.1e3, 4000)
    phases = np.abs(2 * np.emath.arccos(ratios) / np.emath.sqrt(1 - ratios**2))
    return float(np.interp(-math.log(max(restitution, 1e-3)), ratios * phases, phases))


def _recording_of(
    source: str | Path | Mapping[str, Any] | Recording,
    leave_out: tuple[int, ...],
    ball: str | None,
    resolution: Quantity,
    columns: Mapping[str, str] | None,
) -> Recording:
    """Return the recording of one ball."""
    if isinstance(source, Recording):
        return source
    balls = read(source, leave_out, ball, resolution, columns)
    if len(balls) > 1:
        raise Refused(f"the recording has {', '.join(balls)}: name one, --ball")
    return next(iter(balls.values()))


def _drag_note(fitted: Fit, known: Any, rounding: float) -> str:
    """Return what the drag of the air does to r; empty if it is less than half of the interval.

    ``known`` and ``rounding`` are those of `curves_of`.
    """
    recording = fitted.recording
    if recording.kind not in _WITH_DRAG or recording.no_speed:
        return ""
    is_known = bool(fitted.mass and fitted.diameter)
    # A ball of table tennis does not fall faster than 8.6 m/s.
    lightest = STANDARD_GRAVITY / (2 * fitted.impacts.speed.max() ** 2)
    mass, diameter = (fitted.mass, fitted.diameter) if is_known else _TABLE_TENNIS_BALL
    try:
        r_with, r_without = (
            estimate(curves_of(impacts_of(recording, drag), known, fitted.speed, rounding)).of_r[0]
            for drag in (min(drag_of(mass or 0.0, diameter or 0.0), lightest), 0.0)
        )
    except Refused:
        # A film that no ball of table tennis has is one of a heavier ball.
        return ""
    by_drag = r_with - r_without
    note = (
        f"the drag of the air is removed, which raises r by {by_drag:.2g}"
        if is_known
        else f"the drag of the air is not removed: r is too low by {by_drag:.2g} for a ball of "
        "table tennis, and by less for a heavier ball; give --mass and --diameter"
    )
    return note * (2 * by_drag > fitted.interval[1] - fitted.interval[0])


def _contact_note(fitted: Fit, drag: float, known: Any, rounding: float) -> str:
    """Return what the contacts do to r of times between impacts, or of flights that meet."""
    recording = fitted.recording
    is_film = recording.kind == "track" and not recording.no_speed
    if not is_film and (recording.kind != "flights" or recording.is_free):
        return ""
    if fitted.contact_time:
        return (
            f"the contact, {show(fitted.contact_time, 's')}, is taken off each time between two "
            "impacts"
        )
    low, high = fitted.interval
    shorter = impacts_of(without_contacts(recording, _SHORT_CONTACT), drag)
    r = estimate(curves_of(shorter, known, fitted.speed, rounding)).of_r[0]
    lower = (fitted.restitution - r) / _SHORT_CONTACT
    matters = (high - low) / (2 * lower) if lower > 0 else math.inf
    # Contacts of rubber, the longest ones, last for 10 ms.
    within = "flights meet within" if is_film else "times between impacts include"
    return (matters < 0.01) * (
        f"{within} the contact: r is too high by {lower / 1000:.2g} for each ms of it, which "
        f"matters above {show(matters, 's')}; give --contact-time"
    )


def _film_notes(fitted: Fit) -> list[str]:
    """Return what the films leave open of the camera."""
    low, high = fitted.interval
    width = high - low
    v, r = fitted.impacts.speed, fitted.impacts.restitution
    # Derivative of r with respect to a speed of the picture, which adds to one speed of the ball.
    moved = float(np.mean((1 + r) / v))
    films = fitted.impacts.films
    misfit = max((film.misfit for film in films), default=1.0)
    floor = max((abs(film.floor) for film in films), default=0.0)
    is_single = bool(films) and all(len(film.speeds) == 1 for film in films)
    return holding(
        [
            (
                misfit > 1,
                f"the flights are not quite those of one camera that stands still, as with a lens "
                f"that bends lines or a zoom: errors are taken as {misfit:.2g} times as large",
            ),
            (
                floor * KINK * moved > width / 4 and not fitted.recording.has_sideways,
                f"the floor moves by {show(floor, 'm/s')} in the picture: the interval allows for "
                "a ball that drifts in a turned picture; a column x of its positions tells",
            ),
            (
                is_single and moved * _DRIFT > width / 2,
                f"one impact does not show whether the picture of the ball drifts upwards: each "
                f"cm/s changes r by {moved / 100:.2g}, which matters above "
                f"{show(width / 2 / moved, 'm/s')}; film a second impact",
            ),
        ]
    )


def _notes(fitted: Fit, drag: float, known: Any, rounding: float, value: float) -> tuple[str, ...]:
    """Return the notes on a fit, the severest first; `value` is r before it is limited to 1."""
    impacts = fitted.impacts
    v = impacts.speed
    at = fitted.speed
    unit = KINDS[fitted.recording.kind][0]
    wrong = [f"r = {impacts.restitution[i]:.3g} of impact {i + 1}" for i in misread(impacts)]
    by_drag = _drag_note(fitted, known, rounding)
    contact = _contact_note(fitted, drag, known, rounding)
    is_taken_off = bool(contact and fitted.contact_time)
    return tuple(
        holding(
            [
                (
                    wrong,
                    f"{', '.join(wrong)}: far from all others, as by one wrong or missing number; "
                    "--leave-out leaves its line out",
                ),
                *((True, note) for note in _film_notes(fitted)),
                (value > 1, f"r = {value:.4f} is above 1 within its error: 1 is taken"),
                # A speed that is typed is rounded.
                (
                    not (math.isnan(at) or 0.99 * v.min() <= at <= 1.01 * v.max()),
                    f"{show(at, 'm/s')} is outside of the measured speeds",
                ),
                *((True, note) for note in fitted.recording.notes),
                (
                    fitted.recording.kind in ("drops", "heights"),
                    "heights are those of the lowest point of the ball: subtract its diameter from "
                    "those of its top",
                ),
                (by_drag, by_drag),
                (contact and not is_taken_off, contact),
                (
                    0 < fitted._groups < 3,
                    "impacts of one height, film or ball share an error, which the interval "
                    "contains from three on",
                ),
                (
                    len(v) < 3,
                    "the interval is wide, because there are fewer than three impacts",
                ),
                (is_taken_off, contact),
                (
                    rounding > impacts.usual,
                    f"readings are multiples of {show(rounding, unit, 4)}: taken as rounded",
                ),
            ]
        )
    )


def fit(
    source: str | Path | Mapping[str, Any] | Recording,
    speed: Quantity = None,
    *,
    resolution: Quantity = None,
    mass: Quantity = None,
    diameter: Quantity = None,
    contact_time: Quantity = None,
    leave_out: tuple[int, ...] = (),
    ball: str | None = None,
    columns: Mapping[str, str] | None = None,
) -> Fit:
    """Return r of a recording at a speed with its 95 % interval.

    Parameters
    ----------
    source : str, Path, mapping or Recording
        A file, a published experiment by its name, columns with the headings of a file such as
        ``{"time (s)": [0.45, 1.17, 1.75]}``, or a recording.
    speed : Quantity, optional
        By default the middle of the speeds, the geometric mean.
    resolution : Quantity, optional
        The standard deviation of a reading: of a time, a height, a speed, or r.
    mass, diameter : Quantity, optional
        Of the ball, with which the drag of the air is removed from flights, heights and tracks.
    contact_time : Quantity, optional
        A measured one, in place of that of the recording: it is taken off times between impacts,
        which are from touch to touch, and is that of a contact for an engine.
    leave_out : tuple of int
        Lines of the file.
    ball : str, optional
        The name of one, if the file has a column of several.
    columns : mapping, optional
        Headings by the names or the numbers of the columns in the file, as of `read`.

    Raises
    ------
    Refused
        If the recording cannot be read or has several balls, no impact lies between two
        flights, or r is above 1.
    """
    recording = _recording_of(source, leave_out, ball, resolution, columns)

    def given(name: str, value: Quantity, unit: str) -> float | None:
        said = recording.head.get(name) if value is None else value
        return None if said is None else positive(name, said, unit)

    unit = KINDS[recording.kind][0]
    stated = given("resolution", resolution, unit)
    kilograms = given("mass", mass, "kg")
    metres = given("diameter", diameter, "m")
    drag = drag_of(kilograms, metres) if kilograms and metres else 0.0
    # A contact that is not known is taken to have no duration.
    lasts = given("contact time", contact_time, "s") or recording.contact_time
    refuse(
        [
            (
                recording.no_speed and (drag or lasts or speed is not None),
                f"{recording.name}: no speed is known: {recording.no_speed}",
            )
        ]
    )
    if lasts and recording.kind in ("flights", "track") and not recording.is_free:
        recording = without_contacts(recording, lasts)
    impacts = impacts_of(recording, drag)
    v = impacts.speed
    known = impacts.known if stated is None else stated
    rounding = rounding_of(recording) if known is None else 0.0
    middle = math.exp(float(np.mean(np.log(v))))
    at = middle if speed is None else positive("speed", speed, "m/s")
    error = rounding / math.sqrt(12) if known is None else known
    refuse(
        [
            (
                # So far off the exponents of the curves decide, which no reading tells apart.
                not v.min() / 100 <= at <= 100 * v.max(),
                f"{show(at, 'm/s')} is more than 100 times off the measured speeds, "
                f"{span(v.min(), v.max(), form='g')} m/s: nothing is known of r there",
            ),
            (
                all(np.min(np.sum(matrix**2, axis=1)) > 1 for matrix in impacts.errors(error)[0]),
                f"{recording.name}: readings with an error of {show(float(np.max(error)), unit)} "
                "say nothing of r: is a unit missing?",
            ),
        ]
    )
    curves = curves_of(impacts, known, at, rounding)
    estimated = estimate(curves)
    value = math.exp(estimated.value)
    if estimated.low > 0:
        raise Refused(f"{recording.name}: r = {value:.4f} is above 1 by more than its error")
    has_slope = v.max() > v.min() and curves.has_slope
    _, low, high = estimated.of_r
    fitted = Fit(
        recording=recording,
        impacts=impacts,
        speed=math.nan if recording.no_speed else at,
        restitution=min(value, 1.0),
        interval=(low, high),
        scatter=curves.scatter,
        slope=estimated.slope if has_slope else math.nan,
        contact_time=lasts,
        mass=kilograms,
        diameter=metres,
        notes=(),
    )
    return replace(fitted, notes=_notes(fitted, drag, known, rounding, value))

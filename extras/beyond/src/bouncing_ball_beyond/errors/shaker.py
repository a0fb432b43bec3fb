"""Decide whether a restitution coefficient is good enough for a given ball and shaker.

It is good enough if the ball follows the orbit and the orbit is stable in both models, and if the
heights of both models differ by at most a tolerance.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.contacts.balls import (
    Ball,
    RestitutionFit,
    Rigid,
    SpringDamper,
    checked,
    damping_of,
    one_number,
    restitution_of,
    whole_number,
)
from bouncing_ball_beyond.contacts.judge import FIRST_SPEED, LADDER
from bouncing_ball_beyond.contacts.laws import ForceLaw
from bouncing_ball_beyond.contacts.named_laws import linear, tsuji
from bouncing_ball_beyond.errors.error_law import (
    contact_values,
    error_thresholds,
    free_impact,
    law_errors,
    off_rounding,
    restitution_trace,
    restitution_values,
    rows_of_orbits,
)
from bouncing_ball_beyond.periodic.equations import (
    NEUTRAL,
    OrbitEquations,
    multipliers_of,
    other_orbits,
)
from bouncing_ball_beyond.tables.table import SINE, Table, Values, check_table

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity in m/s²."""


ELASTIC = 1 - 1e-9
"""Restitution coefficient above which orbits are only marginally stable, for lack of a loss."""


class ByModel(NamedTuple):
    """One quantity by three methods.

    Attributes
    ----------
    by_restitution : float
        Restitution model.
    exact : float
        Contact model.
    by_law : float
        Contact model, estimated from the restitution model by the error law.
    """

    by_restitution: float
    exact: float
    by_law: float


@dataclass(frozen=True, repr=False)
class ShakerAnswer:
    """Whether a restitution coefficient is good enough, and the limits of bouncing and stability.

    It prints as a short table, followed by the answer in sentences. Values that do not exist are
    NaN.
    """

    n: int
    """Number of periods of the table in which the ball bounces once."""
    amplitude: float
    """Λ, the scale of the waveform. For a sine it is the acceleration divided by gravity."""
    ball: Ball
    """Dimensionless ball with its contact, for the other functions of the package."""
    frequency: float
    """Frequency of the table in Hz."""
    displacement: float
    """Amplitude of the displacement of the table in m: half of the distance between its lowest and
    highest positions.
    """
    contact_duration: float
    """Duration, in s, of a free impact at the closing speed of the orbit."""
    tolerance: float
    """Largest relative error of the height that is allowed."""
    saddle_node: ByModel
    """Λ of the saddle-node, at which the orbit begins. Above it a ball bounces if it can follow the
    orbit: see `obstacle`."""
    period_doubling: ByModel
    """Λ at which the period of the orbit doubles."""
    max_height: ByModel
    """Maximum height of the ball, in m, above the mean position of the table."""
    longest_contact: float
    """Longest contact, in s, with a height within the tolerance, at the same frequency."""
    multiplier: tuple[complex, complex]
    """Floquet multiplier of the larger modulus, in the restitution model and on the contact."""
    table: Table = SINE
    """Waveform of the table."""
    obstacle: tuple[str, str] = ("", "")
    """Why no ball follows the orbit, in the restitution model and on the contact; or ""."""
    others: tuple[float, ...] = ()
    """Closing speeds, in m/s, of other orbits with one impact in n periods, which are not judged.
    They have another r(v), or are next to another rise of the table.
    """
    at_longest: str = ""
    """Why no ball stays on an orbit with the longest contact; or ""."""
    fit: str = ""
    """How well the r that is used fits measured pairs; or ""."""

    @property
    def _begun(self) -> tuple[bool, ...]:
        """Whether a ball follows an orbit, in the restitution model and on the contact."""
        pairs = zip(self.saddle_node[:2], self.obstacle, strict=True)
        return tuple(value <= self.amplitude and not why for value, why in pairs)

    @property
    def bounces(self) -> bool:
        """Whether, in the restitution model and on the contact, a ball follows the orbit."""
        return all(self._begun)

    @property
    def stable(self) -> bool:
        """Whether the orbit is stable, in the restitution model and on the contact."""
        return self.bounces and all(
            abs(multiplier) <= 1 + NEUTRAL for multiplier in self.multiplier
        )

    @property
    def _unstable(self) -> tuple[bool, ...]:
        """Whether the orbit is unstable, in the restitution model and on the contact."""
        return tuple(abs(multiplier) > 1 + NEUTRAL for multiplier in self.multiplier)

    @property
    def error(self) -> float:
        """Height on the contact, divided by the height in the restitution model, minus 1."""
        return self.max_height.exact / self.max_height.by_restitution - 1

    @property
    def is_good_enough(self) -> bool:
        """Whether the orbits of both models exist, are stable, and agree in height.

        If there is no height to compare, this is false, and :attr:`reason` says why.
        """
        return not self.reason

    @property
    def reason(self) -> str:
        """Why a restitution coefficient is not good enough; empty if it is good enough."""
        below = tuple(value > self.amplitude for value in self.saddle_node[:2])
        if any(below):
            return f"Λ is below the saddle-node {WHERE[below]}, so there is no height to compare"
        if any(self.obstacle):
            where = WHERE[tuple(map(bool, self.obstacle))]
            why = " or ".join(dict.fromkeys(filter(None, self.obstacle)))
            return f"no ball follows the orbit {where}: {why}"
        if any(self._unstable):
            where = WHERE[self._unstable]
            return f"{LOST[self._way][0]} {where}, so a ball does not stay on it"
        if not abs(self.error) <= self.tolerance:
            return "the heights of both models differ by more than the tolerance"
        return ""

    @property
    def _way(self) -> str:
        """Way in which the orbit has lost its stability, by its multipliers."""
        lost = [multiplier for multiplier in self.multiplier if abs(multiplier) > 1 + NEUTRAL]
        turning = any(abs(multiplier.imag) > 0 or multiplier.real > 0 for multiplier in lost)
        return "Neimark-Sacker" if turning else "period doubling"

    def __repr__(self) -> str:
        rows = {
            "": ("restitution", "contact", "error law"),
            "begins at Λ": [f"{value:.4g}" for value in self.saddle_node],
            "doubles at Λ": [f"{value:.4g}" for value in self.period_doubling],
            "maximum height/mm": [
                f"{1e3 * value:.4g}".replace("nan", "–") for value in self.max_height
            ],
        }
        lines = [
            f"{name:<18}{''.join(f'{value:>13}' for value in values)}"
            for name, values in rows.items()
        ]
        return "\n".join([*lines, "", *self._sentences()])

    def _doubt(self) -> list[str]:
        """Question on the units of an acceleration that few shakers reach."""
        if self.amplitude * self.table.acceleration < IMPLAUSIBLE:
            return []
        return ["Were millimetres meant? Displacements are in m, and accelerations in m/s²."]

    def _sentences(self) -> list[str]:
        begun = sum(self._begun)
        periods = "each period" if self.n == 1 else f"{self.n} periods"
        sentences = [
            f"The table moves by ±{1e3 * self.displacement:.4g} mm at {self.frequency:.4g} Hz,"
            f" with an acceleration of {self.amplitude * self.table.acceleration:.4g} times gravity"
            f" (Λ = {self.amplitude:.4g})."
            f" A contact lasts {1e6 * self.contact_duration:.4g} µs,"
            f" {self.contact_duration * self.frequency:.2%} of a period.",
            *self._doubt(),
            *([self.fit] if self.fit else []),
            f"The ball {BOUNCES[begun]} once in {periods} of the table.",
        ]
        if self.bounces and np.isnan(self.error):
            sentences.append("Its orbit on the contact is not found at this acceleration.")
        elif self.bounces:
            elastic = self.stable and self.ball.signature(1.0).restitution > ELASTIC
            how = (STABLE + LOST[self._way][1:])[sum(self._unstable)]
            sentences.append(f"This motion is {'marginally ' if elastic else ''}{how}.")
            lower = "lower" if self.error < 0 else "higher"
            beyond = "within" if abs(self.error) <= self.tolerance else "beyond"
            by_law = self.max_height.by_law / self.max_height.by_restitution - 1
            sentences.append(
                f"Its maximum height is {100 * abs(self.error):.3g}% {lower} than with a"
                f" restitution coefficient, {beyond} the tolerance of {100 * self.tolerance:.3g}%;"
                f" the error law predicts {100 * by_law:+.3g}%."
            )
            if self.longest_contact > 0:
                sentences.append(
                    f"Contacts of up to {1e6 * self.longest_contact:.4g} µs are within this"
                    f" tolerance{self.at_longest and f', but with the longest {self.at_longest}'}."
                )
        if self.others:
            speeds = ", ".join(f"{speed:.4g}" for speed in self.others)
            sentences.append(
                f"Other orbits with one impact in {periods} close at {speeds} m/s; they are not"
                " judged here."
            )
        if self.amplitude * self.table.lift < 1:
            sentences.append("A ball that is laid on the table stays there.")
        reason = self.reason
        verdict = "A restitution coefficient is good enough"
        if begun == 0 or (self.bounces and all(self._unstable)):
            verdict = f"Whether a restitution coefficient is good enough has no answer: {reason}"
        elif reason:
            verdict = f"A restitution coefficient is not good enough: {reason}"
        return [*sentences, f"{verdict}."]


IMPLAUSIBLE = 100.0
"""Acceleration in units of gravity above which the answer asks for the units of the user."""

WHERE: dict[tuple, str] = {
    (True, True): "in both models",
    (True, False): "in the restitution model only",
    (False, True): "on the contact only",
}
"""Text on where a condition fails.

A key has two parts: whether the condition fails in the restitution model, and on the contact.
"""
BOUNCES = ("does not bounce", "bounces in one of the two models only:", "bounces")
"""Text on bouncing. The index is the number of models in which the ball bounces."""
STABLE = ("stable", "stable in one of the two models only")
"""Text on stability. The index is the number of models in which the orbit is unstable."""
LOST = {
    "period doubling": ("the orbit has doubled", "unstable, its period has doubled"),
    "Neimark-Sacker": (
        "neighbouring motions turn away from the orbit",
        "unstable, neighbouring motions turn away from it: faster impacts lose less energy",
    ),
}
"""Texts on where and how the orbit has lost its stability."""


def on_shaker(
    *,
    frequency: float,
    restitution: float | Any,
    displacement: float | None = None,
    acceleration: float | None = None,
    mass: float | None = None,
    radius: float | None = None,
    contact_duration: float | None = None,
    stiffness: float | None = None,
    youngs_modulus: float | None = None,
    poissons_ratio: float = 0.3,
    table_youngs_modulus: float | None = None,
    table_poissons_ratio: float = 0.3,
    gravity: float = STANDARD_GRAVITY,
    n: int = 1,
    tolerance: float = 0.01,
    table: Table = SINE,
    release: str = "force",
) -> ShakerAnswer:
    """Decide whether a restitution coefficient is good enough for a ball on a shaker, in SI units.

    Parameters
    ----------
    frequency : float
        Frequency of the table in Hz.
    restitution : float or list of (v, r)
        Restitution coefficient r of a free impact, above 0 and up to 1; or measured pairs of a
        closing speed in m/s and r, as a recording of contacts has them. The contact then has the
        damping of the r of each closing speed. This r, also that of the restitution model, is that
        of a fit (:func:`.restitution_of`), not that of the nearest pair.
    displacement, acceleration : float
        Give exactly one of the two. The displacement, in m, is its amplitude: half of the distance
        between the lowest and highest positions of the table. The acceleration, in m/s², is the
        maximum acceleration of the table.
    mass : float, optional
        Mass of the ball in kg. Not needed with ``contact_duration``.
    radius : float, optional
        Radius of the ball in m. Only needed with ``youngs_modulus``.
    contact_duration, stiffness, youngs_modulus : float
        Give exactly one of the three.

        - Duration of the contact in s, or stiffness in N/m. The contact is then a spring and a
          damper with the given ``release``.
        - Young's modulus of the ball in Pa. The contact is then a Hertz contact with the damping
          of Tsuji. Its r is the same at every speed. The radius of the ball is required.
    poissons_ratio, table_youngs_modulus, table_poissons_ratio : float
        Poisson's ratio of the ball, Young's modulus of the table in Pa, and Poisson's ratio of the
        table, for a contact of Hertz. If no modulus of the table is given, the table is rigid.
    gravity : float
        Acceleration of gravity in m/s².
    n : int
        Number of periods of the table in which the ball bounces once.
    tolerance : float
        Largest relative error of the maximum height.
    table : Table
        Waveform of the table, by default a sine.
    release : {"force", "displacement"}
        What ends the contact of a spring and a damper. A measured contact cannot pull, and ends
        where its force vanishes. Contacts of the paper end at zero depth: "displacement".

    Returns
    -------
    ShakerAnswer

    Raises
    ------
    ValueError
        If a quantity is missing or out of range. If the contact is so compliant that the
        saddle-node or the period doubling is not found. If a measured r differs from the fit so
        much that this difference changes the height by more than the tolerance.

    Examples
    --------
    >>> given = {"frequency": 50.0, "acceleration": 0.8 * 9.80665, "restitution": 0.85}
    >>> answer = on_shaker(**given, mass=0.02, stiffness=1e7)
    >>> answer.is_good_enough, round(answer.error, 4)
    (False, -0.0121)
    """
    rate = 2 * np.pi * one_number("frequency", frequency)
    fall = one_number("gravity", gravity)
    tolerance = one_number("tolerance", tolerance)
    n = whole_number("n", n)
    measured = fit = None
    if np.ndim(restitution):
        fit = restitution_of(restitution)
        measured = _measured(fit, restitution, fall / rate, n)
        if release == "force" and youngs_modulus is None:
            _check_measured(measured, fall / rate)
    else:
        checked("restitution", restitution, 0, 1, low_allowed=False)
    check_table(table)
    if _one_of(displacement=displacement, acceleration=acceleration) == "displacement":
        amplitude = one_number("displacement", displacement) * rate**2 / fall / _half_range(table)
    else:
        amplitude = one_number("acceleration", acceleration) / fall / table.acceleration
    contact = _one_of(
        contact_duration=contact_duration, stiffness=stiffness, youngs_modulus=youngs_modulus
    )
    # contacts(times) is the dimensionless ball on a contact whose duration is divided by `times`.
    if contact == "youngs_modulus":
        compliance = _compliance(youngs_modulus, poissons_ratio, "")
        if table_youngs_modulus is not None:
            compliance += _compliance(table_youngs_modulus, table_poissons_ratio, "table_")
        # Hertz: force 4/3 E* √R p^(3/2). Units are g/Ω² for lengths and 1/Ω for times.
        force = 4 / 3 * np.sqrt(one_number("radius", radius)) / compliance
        force *= np.sqrt(fall) / rate**3 / one_number("mass", mass)
        # The duration and the speed are arbitrary, because the damping depends only on r.
        hertz = tsuji(restitution=0.5 if measured else restitution, duration=0.1, speed=1.0)
        if measured:
            hertz = _damped_by(
                hertz, lambda u: {"damping": np.sqrt(5) * damping_of(measured(u))}, "stiffness"
            )

        def contacts(times: Values) -> Any:
            return hertz.at(stiffness=force * times**2.5)

    else:
        spring: Any = SpringDamper(
            1.0, restitution=restitution if not measured else 0.5, release=release
        )
        if measured:
            spring = _damped_by(
                linear(1.0, 0.1, release=release),
                lambda u: {"damping_ratio": damping_of(measured(u), release)},
                "frequency_ratio",
            )
        if contact == "stiffness":
            square = one_number("stiffness", stiffness) / one_number("mass", mass)
            ratio = np.sqrt(square) / rate
        else:
            contact_time = rate * one_number("contact_duration", contact_duration)
            ratio = float(free_impact(spring, n).duration) / contact_time

        def contacts(times: Values) -> Any:
            return spring.at(frequency_ratio=ratio * times)

    answer = _answer(contacts, amplitude, n, tolerance, rate, fall, table)
    return replace(answer, fit=_checked_fit(fit, answer, fall / rate)) if fit else answer


def _checked_fit(fit: RestitutionFit, answer: ShakerAnswer, unit: float) -> str:
    """Sentence on a fit, whose speeds are in m/s.

    Raises ValueError if its residual changes the height by more than the tolerance.
    """
    impact = free_impact(answer.ball, answer.n)
    speed, r = float(impact.speed) * unit, float(impact.restitution)
    worst = f"{fit.residual:.2g} at {fit.at:.3g} m/s"
    near = np.clip([r - fit.residual, r, r + fit.residual], 0, 1)
    around = free_impact(Rigid(near), answer.n)
    heights = restitution_values(around, answer.amplitude, answer.table)["max_height"]
    change = np.ptp(heights) / heights[1] if np.isfinite(heights).any() else 0.0
    if not change <= answer.tolerance:
        raise ValueError(
            f"restitution: a fit to these pairs, r = {r:.3g} at the {speed:.3g} m/s of this orbit,"
            f" misses a pair by {worst}, too much for a tolerance of {answer.tolerance:.3g} of the"
            " height: give pairs nearer to this speed, or a number"
        )
    return (
        f"r = {r:.4g} is that of a fit to the pairs, at the {speed:.3g} m/s of this orbit; the"
        f" largest residual is {worst}."
    )


def _measured(fit: RestitutionFit, pairs: Values, unit: float, n: int) -> Callable:
    """r(u) of measured pairs, whose speeds are in m/s, if u is in this unit.

    Raises ValueError if the ball of the n-T orbit does not close at a measured speed.
    """

    def restitution(u: Values) -> Values:
        return fit(u * unit)

    closing = float(free_impact(Rigid(restitution), n).speed) * unit
    low, high = np.min(pairs, axis=0)[0], np.max(pairs, axis=0)[0]
    if not low <= closing <= high:
        raise ValueError(
            f"restitution: was measured from {low:.3g} to {high:.3g} m/s, but the ball of this"
            f" orbit closes at {closing:.3g} m/s: measure it there, or give a number"
        )
    return restitution


def _check_measured(measured: Callable, unit: float) -> None:
    """Raise ValueError if no damper has the r of a contact that is judged at these speeds."""
    speeds = FIRST_SPEED * LADDER
    lost = np.flatnonzero(~(measured(speeds) > np.exp(-2)))
    if lost.size:
        speed = speeds[lost[-1]]
        raise ValueError(
            f"restitution: a fit to these pairs falls to r = {float(measured(speed)):.2g} at"
            f" {speed * unit:.2g} m/s, but a damper whose contacts end where the force vanishes has"
            " r above e⁻² = 0.135: measure there, give a number, or release='displacement'"
        )


def _damped_by(law: ForceLaw, damping: Callable, other: str) -> ForceLaw:
    """Return a law whose damping depends on the closing speed. ``other`` is its other parameter."""

    def force(p: Values, v: Values, start_speed: Values, **values: Values) -> Values:
        return law.force(p, v, **values, **damping(start_speed))

    values = {other: law.values[other]}
    return ForceLaw(force, values, law.root, law.release, needs=("start_speed",))


def _half_range(table: Table) -> float:
    highest, lowest = table.peaks
    return (highest - lowest) / 2


def _one_of(**quantities: float | None) -> str:
    given = [name for name, value in quantities.items() if value is not None]
    if len(given) != 1:
        raise ValueError(f"exactly one of {', '.join(quantities)} must be given")
    return given[0]


def _compliance(modulus: float | None, ratio: float, body: str) -> float:
    """Return (1 - ν²)/E of a body. ``body`` is the prefix of its arguments: "" or "table_"."""
    checked(f"{body}poissons_ratio", ratio, -1, 0.5, low_allowed=False)
    return (1 - ratio**2) / one_number(f"{body}youngs_modulus", modulus)


def _answer(
    contacts: Any, amplitude: Values, n: Values, tolerance: Any, rate: Any, fall: Any, table: Table
) -> ShakerAnswer:
    """Return the answer for the ball contacts(1) at Λ.

    ``rate`` is Ω in rad/s, and ``fall`` is gravity in m/s².
    """
    ball = contacts(1.0)
    impact = free_impact(ball, n)
    duration = float(impact.duration)
    simple = restitution_values(impact, amplitude, table)
    law = law_errors(impact, amplitude=amplitude, table=table)
    names = ("saddle_node", "period_doubling", "max_height")
    exact = contact_values(ball, amplitude=amplitude, n=n, quantities=names, table=table)
    if impact.restitution > ELASTIC:
        # The orbits begin at Λ = 0, without a bifurcation.
        simple["saddle_node"] = exact["saddle_node"] = law["saddle_node"] = 0.0
    if np.isnan(exact["saddle_node"] + exact["period_doubling"]):
        raise ValueError(
            f"the saddle-node or the period doubling is not found: a contact lasts"
            f" {duration / (2 * np.pi):.2g} periods of the table; give a shorter contact"
        )
    scale = off_rounding(impact, amplitude, table)
    phase, _, push, _ = table.instant(impact.line, scale)
    models = (
        OrbitEquations(Rigid(np.clip(impact.restitution, 0, 1)), 1, n, table=table),
        OrbitEquations(ball, 1, n, table=table),
    )
    rows = (
        np.array([phase, impact.speed, scale], float),
        rows_of_orbits(models[1], np.array([amplitude]))[0],
    )
    orbits = [
        model.orbit(row) if np.isfinite(row).all() else None
        for model, row in zip(models, rows, strict=True)
    ]
    simple_obstacle, obstacle = (orbit.obstacle if orbit else "" for orbit in orbits)
    multiplier = (
        multipliers_of(*map(float, restitution_trace(impact, push)))[0],
        orbits[1].multipliers[0] if orbits[1] else np.nan,
    )
    longest, at_longest = np.nan, ""
    # Heights are only compared where a ball stays on the orbits of both models.
    if (
        np.all(np.abs(multiplier) <= 1 + NEUTRAL)
        and not (simple_obstacle or obstacle)
        and all(values["saddle_node"] <= amplitude for values in (simple, exact))
    ):
        low = duration / np.pi
        threshold = error_thresholds(
            contacts,
            amplitude=amplitude,
            n=n,
            tolerance=tolerance,
            quantities=["max_height"],
            low=low,
            high=1e6 * low,
            table=table,
        )["max_height"]
        longest = float(duration / threshold.ratio) / rate
        if threshold.inadmissible:
            at_longest = f"no ball follows the orbit ({threshold.inadmissible})"
        elif threshold.unstable:
            at_longest = f"the orbit is unstable {threshold.unstable}"
    others = other_orbits(ball, n, float(amplitude), table, float(phase), float(impact.speed))
    unit = {"saddle_node": 1.0, "period_doubling": 1.0, "max_height": fall / rate**2}
    compared: dict[str, Any] = {
        name: ByModel(
            float(simple[name]) * unit[name],
            float(exact[name]) * unit[name],
            float(simple[name] * (1 + law[name])) * unit[name],
        )
        for name in names
    }
    return ShakerAnswer(
        n=n,
        amplitude=amplitude,
        ball=ball,
        frequency=rate / (2 * np.pi),
        displacement=amplitude * _half_range(table) * fall / rate**2,
        contact_duration=duration / rate,
        tolerance=tolerance,
        longest_contact=longest,
        multiplier=multiplier,
        table=table,
        obstacle=(simple_obstacle, obstacle),
        others=tuple((others[:, 1] * fall / rate).tolist()),
        at_longest=at_longest,
        **compared,
    )

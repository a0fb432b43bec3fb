"""Stage: what the phases of touches tell about a contact, and the error law for any waveform.

On the orbits of one branch w′(φ + θ) = C - s with θ = s + t_c: the level C - s tells the
restitution coefficient, and the angle θ the duration of the contact.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import brentq, root

from bouncing_ball_beyond.contacts.balls import Ball, Rigid, SpringDamper, damping_of
from bouncing_ball_beyond.contacts.named_laws import hunt_crossley, kuwabara_kono, tsuji
from bouncing_ball_beyond.errors.error_law import (
    contact_values,
    free_impact,
    restitution_values,
)
from bouncing_ball_beyond.motions.bounces import Balls, step
from bouncing_ball_beyond.tables.table import Table
from studies.waveforms import WAVEFORMS, contact_orbits

HERTZIAN = {"hunt-crossley": hunt_crossley, "tsuji": tsuji, "kuwabara-kono": kuwabara_kono}
LAWS = ("linear", *HERTZIAN)

AFTER = 0.2
"""Phases after that of the steepest rise at which remainders are measured."""

LIFTS = np.linspace(0.3, 0.85, 4)
"""Λ sin ψ of the orbits that are measured, as shares of that at the period doubling."""

SETTLING = 60
"""Impacts before a simulated measurement; r² to this power is small."""

ABOVE = np.linspace(0.08, 0.2, 9).round(3)
"""Relative heights of Λ above the saddle-node at which balls with a random r are followed."""


def linear(r: float | NDArray, duration: float | NDArray) -> SpringDamper:
    """Contacts with a spring and a damper by r and the duration of a free impact."""
    zeta = damping_of(r)
    return SpringDamper(np.pi / (duration * np.sqrt(1 - zeta**2)), restitution=r)


def contacts(law: str, r: float, duration: NDArray) -> Ball:
    """Contacts of a law whose free impact at the speed v₀ has r and the duration, for n = 1."""
    if law == "linear":
        return linear(r, duration)
    speed = np.full(np.shape(duration), 2 * np.pi / (1 + r))
    return HERTZIAN[law](restitution=np.full(speed.shape, r), duration=duration, speed=speed)


# What the law leaves on tables of three waveforms


def left_by_law(waveform: Table, r: float, ratio: float) -> dict[str, float]:
    """Remainders of the error law times powers of ϖ, and ϖ times the shift of the saddle-node.

    The latter is relative, in max w′. The remainders are those of the phase and of the height on
    one orbit, and of the phase on the orbit at the saddle-node of the restitution model.
    """
    ball = SpringDamper(ratio, restitution=r)
    impact = free_impact(ball, 1)
    start = waveform.steepest
    least = waveform(start, 1)
    delay = impact.shift + impact.centroid

    def by_law(amplitude: NDArray) -> tuple[NDArray, NDArray]:
        instant = waveform.phase_of_slope((impact.line - impact.shift) / amplitude) - impact.shift
        height = amplitude * waveform(instant) - impact.speed * impact.centroid + np.pi**2 / 2
        return instant - impact.centroid, height

    def amplitude_at(phase: float) -> float:
        return float(contact_orbits(waveform, np.array([phase]), ball, 1).amplitude[0])

    phase = np.array([start + AFTER])
    orbits = contact_orbits(waveform, phase, ball, 1)
    law_phase, law_height = by_law(orbits.amplitude)
    # Λ has a minimum at the saddle-node, near which a parabola is right to the third order.
    nodes = start - delay + np.linspace(-1, 1, 5) / ratio
    curve = np.polyfit(nodes - nodes[2], contact_orbits(waveform, nodes, ball, 1).amplitude, 2)
    fold = curve[2] - curve[1] ** 2 / (4 * curve[0])
    amplitude = impact.line / least
    steps = np.array([0.2, 2.0]) / np.sqrt(ratio)
    at_node = brentq(lambda x: amplitude_at(x) - amplitude, *(start + steps), xtol=1e-15)
    return {
        "phase_left": float(ratio**2 * (phase - law_phase)[0]),
        "height_left": float(ratio**2 * (orbits.max_height - law_height)[0]),
        "node_phase_left": float(ratio**1.5 * (at_node - by_law(np.array([amplitude]))[0][0])),
        "node_shift": float(ratio * (fold / amplitude - 1)),
    }


def any_waveform(parameters: dict) -> dict[str, tuple]:
    """These numbers by waveform, restitution coefficient and ϖ, and the shift by the law."""
    names = ("waveform", "restitution", "frequency_ratio")
    remainders = [
        [
            [left_by_law(waveform, r, ratio) for ratio in parameters["frequency_ratio"]]
            for r in parameters["restitution"]
        ]
        for waveform in WAVEFORMS.values()
    ]
    left = {
        key: (names, [[[one[key] for one in row] for row in rows] for rows in remainders])
        for key in remainders[0][0][0]
    }
    units = free_impact(SpringDamper(1.0, restitution=np.array(parameters["restitution"])), 1)
    return left | {"node_shift_law": ("restitution", -units.shift / units.line)}


# The figure


def in_the_plane(parameters: dict) -> dict[str, tuple]:
    """Touches of exact orbits with a sine for several durations, and the lines of the law."""
    r = parameters["shown_restitution"]
    shares = np.array(parameters["shown_share"])
    ball = linear(r, 2 * np.pi * shares)
    phase = np.linspace(0.02, 1.0, parameters["samples"])
    touch_amplitude = [
        contact_orbits(WAVEFORMS["sine"], phase, ball.at(frequency_ratio=ratio), 1).amplitude
        for ratio in np.ravel(ball.frequency_ratio)
    ]
    impact = free_impact(ball, 1)
    shape = ("shown_share", "point")
    return {
        "touch_x": (shape, np.array(touch_amplitude) * np.cos(phase)),
        "touch_y": (shape, np.array(touch_amplitude) * np.sin(phase)),
        "line_level": ("shown_share", impact.line - impact.shift),
        "line_angle": ("shown_share", impact.shift + impact.centroid),
        "restitution_line": ((), float(np.ravel(impact.line)[0])),
    }


def levels(parameters: dict) -> dict[str, tuple]:
    """w′ at the touch and turned by θ, over C, on tables of three waveforms, along max w′."""
    ball = linear(parameters["shown_restitution"], 2 * np.pi * parameters["shown_share"][-1])
    impact = free_impact(ball, 1)
    angle = impact.shift + impact.centroid
    slopes: dict[str, list] = {"steepness": [], "touch_slope": [], "turned_slope": []}
    for waveform in WAVEFORMS.values():
        phase = waveform.steepest + np.linspace(0.05, 0.75, parameters["samples"]) - angle
        amplitude = contact_orbits(waveform, phase, ball, 1).amplitude
        scale = amplitude / impact.line
        slopes["steepness"].append(scale * waveform(waveform.steepest, 1))
        slopes["touch_slope"].append(scale * waveform(phase, 1))
        slopes["turned_slope"].append(scale * waveform(phase + angle, 1))
    return {name: (("waveform", "point"), values) for name, values in slopes.items()}


# Measurements


def reading(phase: NDArray, amplitude: NDArray) -> tuple[float, float]:
    """The level and the angle from the line X cos θ - Y sin θ = C - s through touches on a sine."""
    slope, start = np.polyfit(amplitude * np.sin(phase), amplitude * np.cos(phase), 1)
    angle = np.arctan(slope)
    return start * np.cos(angle), angle


def contact_of(level: float, angle: float) -> tuple[float, float]:
    """r and D + κ of the linear contact, D + κ = D, with a level and an angle, for n = 1."""

    def excess(r: float) -> float:
        impact = free_impact(linear(r, 1.0), 1)
        shift = angle * impact.shift / (impact.shift + impact.centroid)
        return float(impact.line - shift - level)

    r = brentq(excess, 0.05, 0.999, xtol=1e-14)
    impact = free_impact(linear(r, 1.0), 1)
    return r, float(angle / (impact.shift + impact.centroid))


def amplitudes(r: float) -> NDArray:
    """Λ of the orbits that are measured."""
    values = restitution_values(free_impact(Rigid(r), 1), 1.0)
    line = values["saddle_node"]
    lift = np.sqrt(values["period_doubling"] ** 2 - line**2)
    return np.hypot(line, LIFTS * lift)


def exact_contacts(parameters: dict) -> dict[str, tuple]:
    """Readings of exact orbits on contacts of four laws over the true values."""
    shares = np.array(parameters["contact_share"])
    shape = ("law", "restitution", "contact_share")
    sizes = len(LAWS), len(parameters["restitution"]), shares.size
    readings = {
        name: np.empty(sizes)
        for name in ("angle_ratio", "found_restitution", "duration_ratio", "unturned_restitution")
    }
    for place, law in enumerate(LAWS):
        for row, r in enumerate(parameters["restitution"]):
            amplitude = amplitudes(r)
            ball = contacts(law, r, 2 * np.pi * shares[:, np.newaxis])
            phase = contact_values(ball, amplitude=amplitude, quantities=["phase"])["phase"]
            impact = free_impact(ball, 1)
            true_angle = (impact.shift + impact.centroid)[:, 0]
            true_through = (impact.centroid * (1 + r) / r)[:, 0]
            for column, touches in enumerate(phase):
                level, angle = reading(touches, amplitude)
                at = place, row, column
                readings["angle_ratio"][at] = angle / true_angle[column]
                readings["found_restitution"][at], through = contact_of(level, angle)
                readings["duration_ratio"][at] = through / true_through[column]
                # X = C at the touch of the last orbit, as if the contact took no time.
                line = amplitude[-1] * np.cos(touches[-1])
                readings["unturned_restitution"][at] = (np.pi - line) / (np.pi + line)
    return {name: (shape, values) for name, values in readings.items()}


def simulated_measurement(
    r: float, given: SimpleNamespace, generator: np.random.Generator
) -> dict[str, float]:
    """r and D from many simulated measurements: means and standard deviations.

    The phase of each impact has a random error, and each impact a random r.
    """
    share = given.measured_share
    ball = linear(r, 2 * np.pi * share)
    levels_of = amplitudes(r)
    impacts = round(given.duration * given.frequency / levels_of.size)
    jitter = 2 * np.pi * given.frequency * given.jitter
    start = contact_values(ball, amplitude=levels_of, quantities=["phase"])["phase"]
    amplitude = np.tile(levels_of, given.runs)
    phase = np.tile(start, given.runs)
    speed = np.pi + amplitude * np.cos(phase)
    balls = Balls(ball, amplitude, 0 * phase, phase, speed)
    cosine, sine = np.zeros((2, phase.size))
    for impact in range(SETTLING + impacts):
        restitution = r * (1 + given.scatter * generator.standard_normal(phase.size))
        record, _, balls = step(replace(balls, ball=ball.at(damping_ratio=damping_of(restitution))))
        if impact >= SETTLING:
            heard = record[1] + jitter * generator.standard_normal(phase.size)
            cosine += np.cos(heard)
            sine += np.sin(heard)
    mean_phase = np.arctan2(sine, cosine).reshape(given.runs, -1)
    measured = [contact_of(*reading(touches, levels_of)) for touches in mean_phase]
    mean = np.mean(measured, axis=0)
    spread = np.std(measured, axis=0, ddof=1)
    true = 2 * np.pi * share
    return {
        "measured_restitution": mean[0],
        "measured_restitution_error": spread[0],
        "measured_duration": mean[1] / true,
        "measured_duration_error": spread[1] / true,
    }


def measurements(given: SimpleNamespace, generator: np.random.Generator) -> dict[str, tuple]:
    """Simulated measurements of balls with each r."""
    measured = [simulated_measurement(r, given, generator) for r in given.restitution]
    return {
        name: ("restitution", [measurement[name] for measurement in measured])
        for name in measured[0]
    }


# What thresholds do not tell


def bifurcations(ball: Ball) -> NDArray:
    """Λ of saddle-node and period doubling, shape (bifurcation, ...), for n = 1."""
    values = contact_values(ball, amplitude=1.0, quantities=["saddle_node", "period_doubling"])
    return np.array([*values.values()])


def counterfeit(parameters: dict) -> tuple:
    """D + κ of the linear contact with the same two bifurcations, over the true one."""
    r = parameters["shown_restitution"]
    shares = np.array(parameters["contact_share"])
    ratios_of_laws = []
    for law in LAWS:
        ball = contacts(law, r, 2 * np.pi * shares)
        through = np.broadcast_to(free_impact(ball, 1).centroid * (1 + r) / r, shares.shape)
        ratios = []
        for true, sought in zip(through, bifurcations(ball).T, strict=True):
            solution = root(
                lambda x, sought=sought: bifurcations(linear(*x)) - sought, [r, true], tol=1e-12
            )
            ratios.append(solution.x[1] / true if solution.success else np.nan)
        ratios_of_laws.append(ratios)
    return ("law", "contact_share"), ratios_of_laws


def width_change(parameters: dict) -> tuple:
    """Relative change of Λ_PD² - Λ_SN² by a contact of the measured duration."""
    r = np.array(parameters["restitution"])
    balls = Rigid(r), linear(r, 2 * np.pi * parameters["measured_share"])
    without, width = (-np.subtract(*bifurcations(ball) ** 2) for ball in balls)
    return "restitution", width / without - 1


def escapes(given: SimpleNamespace, generator: np.random.Generator) -> dict:
    """The share of balls with a random r that stay on the orbit of the restitution model."""
    r = given.measured_restitution
    line = np.pi * (1 - r) / (1 + r)
    impacts = round(given.duration * given.frequency)
    amplitude = np.tile(line * (1 + ABOVE), given.runs)
    phase = np.arccos(line / amplitude)
    speed = np.full(phase.size, 2 * np.pi / (1 + r))
    balls = Balls(Rigid(r), amplitude, 0 * phase, phase, speed)
    left = np.arange(phase.size)
    for _ in range(impacts):
        restitution = r * (1 + given.scatter * generator.standard_normal(left.size))
        record, going, after = step(replace(balls, ball=Rigid(restitution)))
        # A ball that has left its orbit lands in another period of the table.
        kept = np.abs(record[-1, going] - 2 * np.pi) < np.pi / 2
        left = left[going[kept]]
        balls = after.take(kept)
    stays = np.isin(np.arange(phase.size), left).reshape(given.runs, -1).mean(axis=0)
    # The shares rise with Λ but for chance.
    half = np.interp(0.5, np.maximum.accumulate(stays), ABOVE)
    return {"staying": ("above", stays), "half_escape": half}


def ext_phase(parameters: dict) -> xr.Dataset:
    """Levels and angles of exact orbits, what they tell, and what thresholds do not tell."""
    given = SimpleNamespace(**parameters)
    generator = np.random.default_rng(given.seed)
    return xr.Dataset(
        any_waveform(parameters)
        | in_the_plane(parameters)
        | levels(parameters)
        | exact_contacts(parameters)
        | measurements(given, generator)
        | escapes(given, generator)
        | {"counterfeit": counterfeit(parameters), "width_change": width_change(parameters)},
        {
            "waveform": list(WAVEFORMS),
            "restitution": given.restitution,
            "frequency_ratio": given.frequency_ratio,
            "law": list(LAWS),
            "contact_share": given.contact_share,
            "shown_share": given.shown_share,
            "above": ABOVE,
        },
    )


STAGE = {"ext_phase": ext_phase}

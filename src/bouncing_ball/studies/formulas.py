r"""Every formula of the paper that can be wrong, against a second computation.

The restitution model is checked against its event-driven simulation: orbits
by one cycle, stability by finite differences of one cycle. The contact is
checked against the matrix exponential of its equation of motion, in which the
table's sine and cosine are states of their own::

    (z, z′, 1, cos τ, sin τ)′ = M (z, z′, 1, cos τ, sin τ)

so that nothing of the closed forms enters. Each row gives the largest
disagreement over a sample of parameters and what rounding accounts for.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from scipy.linalg import expm
from scipy.optimize.elementwise import find_minimum, find_root

from bouncing_ball.datasets.variables import describe
from bouncing_ball.simulation.restitution import impact_cycle, lift_off_phase
from bouncing_ball.studies import printed

# Flow, roots and minima are right to rounding, 1e-16, amplified by the terms
# that cancel in them: 10⁴ covers the samples below.
ROUNDING = 1e-12
# Central differences over 1e-5 leave h² f‴/6 and rounding/h, both about 1e-10,
# in the trace; at the bifurcation they enter divided by its slope along φ.
DIFFERENCES = 1e-8
_STEP = 1e-5
_SOFT = 1e-4
# The faintest rebound that a double can hold.
_FAINT = float(np.finfo(float).tiny)


class Check(NamedTuple):
    """One formula: largest disagreement, what rounding allows, and with what."""

    disagreement: float
    budget: float
    comparison: str


def _largest(*defects) -> float:
    return float(max(np.max(np.abs(x)) for x in defects))


def _contact_matrix(frequency_ratio, damping_ratio, amplitude, gravity=1.0, driven=1.0):
    """M of z″ = -g - 2ζϖ(z′ - w′) - ϖ²(z - w), w = Λ sin; shape (..., 5, 5)."""
    omega, zeta, lam, g = np.broadcast_arrays(frequency_ratio, damping_ratio, amplitude, gravity)
    matrix = np.zeros((*omega.shape, 5, 5))
    loss, stiffness = 2 * zeta * omega, omega**2
    matrix[..., 0, 1] = 1
    matrix[..., 1, 0], matrix[..., 1, 1], matrix[..., 1, 2] = -stiffness, -loss, -g
    matrix[..., 1, 3], matrix[..., 1, 4] = loss * lam * driven, stiffness * lam * driven
    matrix[..., 3, 4], matrix[..., 4, 3] = -1, 1
    return matrix


def _flow(matrix, time, state):
    time = np.asarray(time)[..., np.newaxis, np.newaxis]
    return np.squeeze(expm(matrix * time) @ state[..., np.newaxis], -1)


def _state(height, velocity, phase):
    return np.stack(
        np.broadcast_arrays(height, velocity, 1.0, np.cos(phase), np.sin(phase)), axis=-1
    ).astype(float)


def _exact_cycle(phase, velocity, r, lam):
    cycle = impact_cycle(r, lam, phase, velocity)
    return cycle.phase, cycle.velocity


def _holmes_cycle(phase, velocity, r, lam):
    """The high-bounce map: the flight as if it ended where it began."""
    landed = phase + 2 * velocity
    return landed, r * velocity + (1 + r) * lam * np.cos(landed)


def _stability(cycle, phase, velocity, r, lam):
    """Trace and determinant of one cycle by central differences."""
    columns = []
    for d_phase, d_velocity in ((_STEP, 0.0), (0.0, _STEP)):
        high = cycle(phase + d_phase, velocity + d_velocity, r, lam)
        low = cycle(phase - d_phase, velocity - d_velocity, r, lam)
        columns.append([(h - b) / (2 * _STEP) for h, b in zip(high, low, strict=True)])
    (tt, vt), (tv, vv) = columns
    return tt + vv, tt * vv - tv * vt


def _located_doubling(cycle, n, r):
    """Λ of the period doubling of a map, along the orbits of Eq. 6."""
    fold = printed.saddle_node(n, r)

    def flip(phase, n, r, fold):
        trace, det = _stability(cycle, phase, n * np.pi, r, fold / np.cos(phase))
        return 1 + trace + det

    # Λ = Λ_SN/cos φ: from the saddle-node, where it is positive, far to the right.
    bracket = (np.full_like(r, 1e-3), np.full_like(r, np.pi / 2 - 1e-3))
    return fold / np.cos(find_root(flip, bracket, args=(n, r, fold)).x)


def _restitution_checks(rng, samples) -> dict[str, Check]:
    r, lam = rng.uniform(0.1, 0.95, samples), rng.uniform(0.1, 3, samples)
    phase = rng.uniform(-np.pi, np.pi, samples)
    velocity = lam + rng.uniform(0.5, 6, samples)
    cycle = impact_cycle(r, lam, phase, velocity)
    bounced = printed.bounced_velocity(phase, velocity, cycle.time, lam, r)
    defect = printed.landing_defect(phase, velocity, cycle.time, lam)

    n = rng.integers(1, 6, samples).astype(float)
    fold = printed.saddle_node(n, r)
    above = fold * rng.uniform(1.01, 3, samples)
    phi, launch = printed.fixed_point(n, r, above)
    back = impact_cycle(r, above, phi, launch)
    returned = np.angle(np.exp(1j * (back.phase - phi))), back.velocity - launch

    # A ball at rest on tables a little below and above the threshold.
    edge = 1 + np.array([-1, 1]) * ROUNDING
    stays = np.isnan(lift_off_phase(edge))
    trace, det = _stability(_exact_cycle, 0.0 * r, n * np.pi, r, fold)
    doubling = printed.period_doubling(n, r)
    exact, holmes = (_located_doubling(cycle, n, r) for cycle in (_exact_cycle, _holmes_cycle))
    lift = 2 * (1 + r * r) / (1 + r) ** 2
    return {
        "Eq. 5": Check(
            _largest(defect, bounced - cycle.velocity), ROUNDING, "simulated flight and impact"
        ),
        "Eq. 6": Check(_largest(*returned), ROUNDING, "one simulated cycle"),
        "Eq. 7": Check(_largest(1 - trace + det), DIFFERENCES, "a Floquet multiplier at 1"),
        "Eq. 8": Check(
            _largest(doubling / exact - 1), DIFFERENCES, "multiplier at -1 of the map of Eq. 5"
        ),
        "Eq. 8, Holmes' map": Check(
            _largest(doubling / holmes - 1), DIFFERENCES, "multiplier at -1 of Holmes' map"
        ),
        "Eq. 8, corrected": Check(
            _largest(np.hypot(lift, fold) / exact - 1),
            DIFFERENCES,
            "multiplier at -1 of the map of Eq. 5",
        ),
        "Eq. 9": Check(
            0.0 if stays.tolist() == [True, False] else 1.0, ROUNDING, "lift-off of a ball at rest"
        ),
    }


def _contact_checks(rng, samples) -> dict[str, Check]:
    omega, zeta = np.exp(rng.uniform(0.2, 3, samples)), rng.uniform(0, 0.6, samples)
    lam, phase = rng.uniform(0.1, 2, samples), rng.uniform(-np.pi, np.pi, samples)
    impact = -rng.uniform(1, 6, samples)
    time = np.pi / omega * rng.uniform(0.2, 1, samples)
    start = _state(lam * np.sin(phase), impact, phase)
    there = _flow(_contact_matrix(omega, zeta, lam), time, start)

    def printed_contact(ratio):
        """Eqs. 12-13 from the same impact; A and B are linear in it (Eqs. 21-22)."""
        zero, rate = printed.contact(0.0, ratio, zeta, lam, phase, 0.0, 0.0)
        a = start[:, 0] - zero
        b = (impact - rate + zeta * ratio * a) / (ratio * np.sqrt(1 - zeta**2))
        return printed.contact(time, ratio, zeta, lam, phase, a, b)

    scale = np.abs(impact)

    def defect(ratio):
        height, velocity = printed_contact(ratio)
        return _largest((height - there[:, 0]) / scale, (velocity - there[:, 1]) / scale)

    # Eq. 10 in physical units: k/m = ω², c/m = 2ζω, gravity g, table a sin Ωt.
    big_omega, gravity = rng.uniform(20, 60, samples), 9.81
    natural = omega * big_omega
    metres = gravity / big_omega**2
    matrix = np.zeros((samples, 5, 5))
    matrix[:, 0, 1], matrix[:, 1, 2] = 1, -gravity
    matrix[:, 1, 0], matrix[:, 1, 1] = -(natural**2), -2 * zeta * natural
    matrix[:, 1, 3] = 2 * zeta * natural * lam * metres * big_omega
    matrix[:, 1, 4] = natural**2 * lam * metres
    matrix[:, 3, 4], matrix[:, 4, 3] = -big_omega, big_omega
    seconds = time / big_omega
    real = _state(start[:, 0] * metres, impact * metres * big_omega, phase)
    height = _flow(matrix, seconds, real)[:, 0] / metres

    def scaled(ratio):
        return _largest((printed_contact(ratio)[0] - height) / scale)

    release, thrown = time, rng.uniform(1, 6, samples)
    since = rng.uniform(0.5, 6, samples)
    falling = _contact_matrix(0 * omega, 0.0, 0.0)
    flown = _flow(falling, since, _state(lam * np.sin(release + phase), thrown, 0.0))
    flight = printed.flight(release + since, release, thrown, lam, phase)
    return {
        "definition of ϖ": Check(
            scaled(1 / omega), ROUNDING, "Eq. 10 in physical units, ϖ = Ω/ω as printed"
        ),
        "definition of ϖ, inverted": Check(
            scaled(omega), ROUNDING, "Eq. 10 in physical units, ϖ = ω/Ω"
        ),
        "Eqs. 12-13": Check(defect(omega), ROUNDING, "matrix exponential of Eq. 11"),
        "Eqs. 14-15": Check(
            _largest(flight[0] - flown[:, 0], flight[1] - flown[:, 1]),
            ROUNDING,
            "matrix exponential of the free fall",
        ),
    }


def _measured_restitution(r, frequency_ratio, velocity, gravity):
    """-δ′ at release over δ′ at impact on a table at rest, by root finding."""
    zeta = printed.damping_ratio(r)
    matrix = _contact_matrix(frequency_ratio, zeta, 0.0, gravity)
    start = _state(0.0, -np.asarray(velocity, dtype=float) + 0 * r, 0.0)

    def displacement(time, row):
        # The rows whose roots are still looked for.
        rows = row.astype(int)
        return _flow(matrix[rows], time, start[rows])[:, 0]

    half = np.pi / (frequency_ratio * np.sqrt(1 - zeta**2))
    # The first return to δ = 0; gravity prolongs the contact.
    bracket = (half / 2, 1.5 * half)
    end = find_root(displacement, bracket, args=(np.arange(float(r.size)),)).x
    return _flow(matrix, end, start)[:, 1] / velocity


def _damping_checks(rng, samples) -> dict[str, Check]:
    r, omega = rng.uniform(0.1, 0.99, samples), np.exp(rng.uniform(0, 5, samples))
    weightless = _measured_restitution(r, omega, 1.0, 0.0)
    return {
        "Eq. 16": Check(
            _largest(weightless - r), ROUNDING, "simulated impact, table at rest, no gravity"
        ),
        "Eq. 16, r = 1": Check(_largest(printed.damping_ratio(1.0)), ROUNDING, "no damping"),
        # For r → 0, 1 - ζ tends to π²/(2 ln² r): slowly.
        "Eq. 16, r → 0": Check(
            _largest(1 - printed.damping_ratio(_FAINT)),
            np.pi**2 / (2 * np.log(_FAINT) ** 2),
            "critical damping",
        ),
    }


def _static_error(static: Mapping[str, Any]) -> xr.DataArray:
    """|r_static - r|/r of a heavy ball on a table at rest, over r and ϖ."""
    r, ratio = (np.array(static[key], dtype=float) for key in ("restitution", "frequency_ratio"))
    grid = [x.ravel() for x in np.meshgrid(r, ratio, indexing="ij")]
    heavy = _measured_restitution(*grid, static["velocity"], 1.0)
    error = np.abs(heavy / grid[0] - 1).reshape(r.size, ratio.size)
    return xr.DataArray(error, {"restitution": r, "frequency_ratio": ratio})


def _steady_amplitude(frequency_ratio, damping_ratio):
    """Amplitude of δ for Λ = 1: the orbit of period 2π of the flow."""
    matrix = _contact_matrix(frequency_ratio, damping_ratio, 1.0, gravity=0.0)
    period = expm(matrix * 2 * np.pi)
    eye = np.eye(2)
    drive = period[..., :2, 3]  # from cos 0 = 1
    orbit = np.squeeze(np.linalg.solve(eye - period[..., :2, :2], drive[..., np.newaxis]), -1)
    start = _state(orbit[..., 0], orbit[..., 1], 0.0)
    quarter = _flow(matrix, np.pi / 2, start)
    # δ = z - sin τ at τ = 0 and π/2, a quarter apart.
    return np.hypot(start[..., 0], quarter[..., 0] - 1)


def _permanent_checks(rng, samples) -> dict[str, Check]:
    omega, zeta = np.exp(rng.uniform(-0.5, 2, samples)), rng.uniform(0.02, 0.5, samples)
    lam = rng.uniform(0.1, 2, samples)
    begin = rng.uniform(-np.pi, np.pi, samples)
    matrix = _contact_matrix(omega, zeta, lam)

    def steady(time):
        return printed.steady_displacement(time, omega, zeta, lam)

    # z = δ + w; the velocity of the printed solution a quarter of a cycle away.
    mean = -1 / omega**2
    rate = steady(begin + np.pi / 2) - mean + lam * np.cos(begin)
    later = rng.uniform(0.5, 6, samples)
    there = _flow(matrix, later, _state(steady(begin) + lam * np.sin(begin), rate, begin))
    defect = there[:, 0] - lam * np.sin(begin + later) - steady(begin + later)

    threshold = 1 / (omega**2 * _steady_amplitude(omega, zeta))
    lowest = find_minimum(
        lambda x, zeta: printed.permanent_contact_threshold(1 / np.sqrt(x), zeta),
        (0.0 * zeta + 1e-3, 1 - 2 * zeta**2, 0.0 * zeta + 10),
        args=(zeta,),
    )
    # Λ between the minimum and 1, where both frequency ratios exist.
    bottom, place = lowest.f_x, 1 / np.sqrt(lowest.x)
    level = bottom + (1 - bottom) * rng.uniform(0.1, 0.9, samples)

    def crossing(low, high):
        return find_root(
            lambda ratio, level, zeta: printed.permanent_contact_threshold(ratio, zeta) - level,
            (low, high),
            args=(level, zeta),
        ).x

    roots = crossing(place, 0 * place + 1e4), crossing(0 * place + 1e-2, place)
    inverse = {
        equation: printed.permanent_contact_frequency_ratio(level, zeta, sign) / root - 1
        for equation, sign, root in (("Eq. 34", 1, roots[0]), ("Eq. 35", -1, roots[1]))
    }
    return {
        "Eq. 31": Check(_largest(defect), ROUNDING, "matrix exponential of Eq. 11"),
        "Eq. 33": Check(
            _largest(printed.permanent_contact_threshold(omega, zeta) / threshold - 1),
            ROUNDING,
            "period of the flow",
        ),
        "Eq. 33, ϖ = 1": Check(
            _largest(2 * zeta * _steady_amplitude(1.0, zeta) - 1), ROUNDING, "period of the flow"
        ),
        # Λ_SD grows as 1/ϖ², with a next term of relative order ϖ².
        "Eq. 33, ϖ → 0": Check(
            _largest(1 / _steady_amplitude(_SOFT, zeta) - 1), 2 * _SOFT**2, "period of the flow"
        ),
        **{
            equation: Check(_largest(defect), ROUNDING, "roots of Eq. 33")
            for equation, defect in inverse.items()
        },
        "Eq. 36": Check(
            _largest(printed.permanent_contact_minimum(zeta) / bottom - 1),
            ROUNDING,
            "minimum of Eq. 33",
        ),
    }


def formulas(parameters: Mapping[str, Any]) -> xr.Dataset:
    """Disagreement of every printed formula, over ``samples`` random parameters.

    Parameters
    ----------
    parameters : mapping
        ``samples``, ``seed``, and ``static`` with the ``restitution``,
        ``frequency_ratio`` and ``velocity`` of an impact on a table at rest.
    """
    rng = np.random.default_rng(parameters["seed"])
    samples = parameters["samples"]
    parts: list[Callable[..., dict[str, Check]]] = [
        _restitution_checks,
        _contact_checks,
        _damping_checks,
        _permanent_checks,
    ]
    checks: dict[str, Check] = {}
    for part in parts:
        checks |= part(rng, samples)
    columns = list(zip(*checks.values(), strict=True))
    return describe(
        xr.Dataset(
            {
                "disagreement": ("formula", np.array(columns[0])),
                "budget": ("formula", np.array(columns[1])),
                "compared_with": ("formula", np.array(columns[2])),
                "static_error": _static_error(parameters["static"]),
            },
            coords={"formula": list(checks)},
        )
    )

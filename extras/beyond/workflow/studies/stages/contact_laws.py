"""Stage: errors of the restitution model and of the corrected model on contacts of other laws.

All contacts have the same restitution coefficient r and the same centroid t_c of the force of the
free impact. If D is its duration and κ = -δ_b/δ′_b at its end, t_c = r (D + κ)/(1 + r) for every
law, and to first order the height depends on D only through t_c. A contact of Hertz has no ϖ; in
its place is π/(D + κ), the ϖ of the elastic linear contact with the same D + κ.

For most laws r and t_c depend on the speed. A contact is calibrated: it has the given ones at one
speed. This is that with which the ball hits it on the orbit, which is found together with the
contact, or v₀ = 2nπ/(1 + r), that of the restitution model's orbit. They differ by a term of order
1/ϖ. If r depends on the speed, this changes the error of the restitution model in its first order.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import Ball, Corrected, Rigid, Signature, SpringDamper
from bouncing_ball_beyond.contacts.laws import ForceLaw
from bouncing_ball_beyond.contacts.named_laws import hunt_crossley, kuwabara_kono, tsuji
from bouncing_ball_beyond.errors.error_law import (
    contact_values,
    free_impact,
    law_errors,
    restitution_values,
)
from bouncing_ball_beyond.periodic.equations import OrbitEquations
from bouncing_ball_beyond.periodic.paths import Path
from bouncing_ball_beyond.periodic.search import guess_of_instants
from bouncing_ball_beyond.tables.table import SINE, Table
from paper_replication.datasets import grid
from studies.orbits import flight_height, last_zero, solved

LINEAR = {"linear": "displacement", "linear, force release": "force"}
OF_HERTZ = {"hunt-crossley": hunt_crossley, "tsuji": tsuji, "kuwabara-kono": kuwabara_kono}
LAWS = (*LINEAR, *OF_HERTZ)
CALIBRATIONS = ("orbit on the contact", "orbit of the restitution model")
QUANTITIES = (
    *("max_height", "bounce_velocity", "phase", "apparent_restitution"),
    *("saddle_node", "period_doubling"),
)
BIFURCATIONS = {"saddle_node", "period_doubling"}

# Over the speed the signature is a polynomial on this range of the calibrated speed, up to rounding
# errors. All speeds that occur are well inside.
SPEEDS = (0.4, 1.8)
DEGREE = 32

# The π/(D + κ) from which the first guesses of thresholds are extrapolated as K/ϖ.
STIFF = 100.0

# Contacts of one law. That with D + κ = 1 at the speed 1 is the unit contact. All others differ
# from it in the units of length and time, in which their parameters have the same values.


@dataclass(frozen=True)
class Ratio(Path):
    """π/(D + κ) as what changes along contacts, from unit contacts on."""

    name: str = "ratio"

    def apply(
        self, value: Any, ball: Ball, amplitude: Any = None, table: Table = SINE
    ) -> tuple[Ball, Any, Table]:
        """The contacts with other D + κ at the same speed."""
        if isinstance(ball, ForceLaw):
            powers = {name: length + time for name, (_, length, time) in ball.units.items()}
            return scaled(ball, np.pi / value, powers), amplitude, table
        ratio = ball.parameters["frequency_ratio"] * value / np.pi
        return ball.at(frequency_ratio=ratio), amplitude, table


@dataclass(frozen=True)
class Speed(Path):
    """The speed at which contacts have their r and D + κ, as what changes, from the speed 1 on."""

    name: str = "speed"

    def apply(
        self, value: Any, ball: Ball, amplitude: Any = None, table: Table = SINE
    ) -> tuple[Ball, Any, Table]:
        """The contacts at other speeds; linear contacts are the same at every speed."""
        if isinstance(ball, ForceLaw):
            powers = {name: length for name, (_, length, _) in ball.units.items()}
            return scaled(ball, value, powers), amplitude, table
        return ball, amplitude, table


def scaled(ball: Ball, factor, powers: dict) -> Ball:
    """The ball with parameters times powers of a factor."""
    return ball.at(
        **{name: ball.parameters[name] * factor**power for name, power in powers.items()}
    )


def unit_contact(law: str, r: float) -> Ball:
    """The contact of a law with r and D + κ = 1 at the speed 1."""
    if law in LINEAR:
        ball: Ball = SpringDamper(1.0, restitution=r, release=LINEAR[law])
    else:
        ball = OF_HERTZ[law](restitution=r, duration=1.0, speed=1.0)
    impact = ball.signature(1.0)
    through = float(impact.centroid * (1 + impact.restitution) / impact.restitution)
    return Ratio().apply(np.pi * through, ball)[0]


@dataclass(frozen=True)
class Known(Ball):
    """A row of contacts of which only the signature is known, by that of their unit contact.

    `unit` is a function of the speed; `speed` and `through` are the calibrated speed and D + κ.
    """

    unit: Callable
    speed: NDArray
    through: NDArray

    def signature(self, u) -> Signature:
        """That of the unit contact, in other units."""
        r, *times = self.unit(u / self.speed)
        return Signature(r, *(time * self.through for time in times))


def by_polynomials(ball: Ball) -> Callable:
    """The signature of a contact as a function of the speed, from few speeds."""
    nodes = chebyshev.chebpts1(DEGREE + 1)
    middle = np.mean(SPEEDS)
    half = np.ptp(SPEEDS) / 2
    values = np.broadcast_arrays(*ball.signature(middle + half * nodes))
    coefficients = chebyshev.chebfit(nodes, np.transpose(values), DEGREE)
    return lambda u: chebyshev.chebval((u - middle) / half, coefficients)


# Errors along π/(D + κ)


def errors(law: str, case: dict, ratios: NDArray, quantities=QUANTITIES) -> NDArray:
    """Signed errors of both models on contacts that are calibrated at the orbit on them, shape
    (model, quantity, ratio).
    """
    unit = unit_contact(law, case["restitution"])
    row, *_ = Ratio().apply(ratios, unit)
    n = np.full(ratios.shape, case["n"])
    amplitude = np.full(ratios.shape, case["amplitude"])
    constant = free_impact(Rigid(case["restitution"]), case["n"])
    near, *_ = Speed().apply(np.full(ratios.shape, constant.speed), row)
    # The calibrated speed is in the place of Λ.
    z = guess_of_instants(near, n, amplitude)
    z[:, -1] = z[:, 1]
    equations = OrbitEquations(row, 1, n, amplitude, (Speed(),))
    z = solved(equations, z, lambda z: z[:, [-1]] - z[:, [1]])
    ball, *_ = Speed().apply(z[:, -1], row)
    ends = equations.ends(z)
    given = {"amplitude": case["amplitude"], "n": case["n"]}
    exact = {
        "max_height": equations.max_height(z),
        "bounce_velocity": (ends.speed + case["amplitude"] * np.cos(ends.leaves))[:, 0],
        "phase": z[:, 0],
        "apparent_restitution": ends.speed[:, 0] / z[:, 1],
        **contact_values(ball, quantities=[*BIFURCATIONS & {*quantities}], **given),
    }
    known = Known(by_polynomials(unit), z[:, -1], np.pi / ratios)
    corrected = contact_values(Corrected(known), quantities=quantities, **given)
    models = restitution_values(constant, case["amplitude"]), corrected
    return np.array([[exact[q] / model[q] - 1 for q in quantities] for model in models])


def errors_and_zeros(law: str, case: dict, ratios: NDArray) -> tuple[NDArray, NDArray]:
    """Errors along π/(D + κ), and the largest at which each is zero, shape (model, quantity).

    They are NaN below the smallest π/(D + κ) above which all contacts have the orbit.
    """
    relative_errors = errors(law, case, ratios)
    missing = np.flatnonzero(np.isnan(relative_errors).any(axis=(0, 1)))
    relative_errors[..., : missing.max(initial=-1) + 1] = np.nan
    zeros = np.full(relative_errors.shape[:2], np.nan)
    for model, quantity in np.ndindex(zeros.shape):

        def error(ratio: float, model=model, quantity=quantity) -> float:
            one = errors(law, case, np.array([ratio]), [QUANTITIES[quantity]])
            return float(one[model, 0, 0])

        zeros[model, quantity] = last_zero(ratios, relative_errors[model, quantity], error)
    return relative_errors, zeros


# Thresholds


def thresholds(law: str, cases: list[dict], parameters: dict) -> tuple[NDArray, NDArray]:
    """The π/(D + κ) at which the errors of the maximum height are the tolerance, NaN out of the
    range, and whether the orbits are stable and admissible there; shape (case, calibration).
    """
    rows = [case for case in cases for _ in CALIBRATIONS]
    on_contact = np.tile([1.0, 0.0], len(cases))
    units = [unit_contact(law, case["restitution"]) for case in rows]
    unit = units[0].at(
        **{
            name: np.array([contact.parameters[name] for contact in units])
            for name in units[0].parameters
        }
    )
    n = np.array([case["n"] for case in rows])
    amplitude = np.array([case["amplitude"] for case in rows])
    constant = free_impact(Rigid(np.array([case["restitution"] for case in rows])), n)
    speed = constant.speed
    fast, *_ = Speed().apply(speed, unit)
    stiff, *_ = Ratio().apply(STIFF, fast)
    error = law_errors(stiff, amplitude=amplitude, n=n)["max_height"]
    tolerance = parameters["tolerance"]
    ratio = STIFF * np.abs(error) / tolerance
    near, *_ = Ratio().apply(ratio, fast)
    sought = (1 + np.sign(error) * tolerance) * restitution_values(constant, amplitude)[
        "max_height"
    ]
    equations = OrbitEquations(unit, 1, n, amplitude, (Ratio(), Speed()))
    z = guess_of_instants(near, n, amplitude)
    z = np.column_stack([z[:, :-1], ratio, speed])

    def conditions(z: NDArray) -> NDArray:
        calibrated = on_contact * z[:, 1] + (1 - on_contact) * speed
        return np.stack([flight_height(equations, z) - sought, z[:, -1] - calibrated], axis=-1)

    z = solved(equations, z, conditions)
    threshold = z[:, -2]
    low, high = (parameters["frequency_ratio"][end] for end in ("min", "max"))
    inside = (threshold >= low) & (threshold <= high)
    stable = (
        inside & (np.abs(equations.turn(equations.linearized(z))) < 1) & equations.admissible(z)
    )
    shape = len(cases), len(CALIBRATIONS)
    return np.where(inside, threshold, np.nan).reshape(shape), stable.reshape(shape)


def ext_laws(parameters: dict) -> xr.Dataset:
    """Errors of both models on contacts of five laws, and the π/(D + κ) from which on the greatest
    height of the restitution model is within the tolerance.

    The first case is the orbit of the errors, the others are the `further` orbits.
    """
    ratios = grid(parameters["frequency_ratio"])
    cases = [parameters, *parameters["further"]]
    errors_by_law = [errors_and_zeros(law, parameters, ratios) for law in LAWS]
    heights = [thresholds(law, cases, parameters) for law in LAWS]
    by_case = ("case", "calibration", "law")
    return xr.Dataset(
        {
            "relative_error": (
                ("law", "model", "quantity", "centroid_ratio"),
                [np.abs(error) for error, _ in errors_by_law],
            ),
            "law_error_zero": (("law", "model", "quantity"), [zeros for _, zeros in errors_by_law]),
            "error_calibration": CALIBRATIONS[0],
            "error_threshold": (
                by_case,
                np.stack([threshold for threshold, _ in heights], axis=-1),
            ),
            "stable_at_threshold": (
                by_case,
                np.stack([is_stable for _, is_stable in heights], axis=-1),
            ),
        },
        {
            **{
                name: ("case", [case[name] for case in cases])
                for name in ("n", "restitution", "amplitude")
            },
            "law": list(LAWS),
            "model": ["restitution", "corrected"],
            "quantity": list(QUANTITIES),
            "centroid_ratio": ratios,
            "calibration": list(CALIBRATIONS),
        },
    )


STAGE = {"ext_laws": ext_laws}

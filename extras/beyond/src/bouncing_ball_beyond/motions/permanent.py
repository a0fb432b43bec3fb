"""Find the amplitude up to which a ball that lies on the table stays on it, for any contact.

The steady motion of the ball in contact has the period of the table. Its penetration p obeys
p″ = 1 + ΛW″ - f(p, p′). The ball is released where its grip falls to zero. The grip is p, or
:meth:`.Force.grip` for the release "force". As Λ rises from 0, the minimum of the grip falls from
its value at rest. The threshold is the Λ at which it is zero (Eq. 33 for a spring and a damper).
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_bvp
from scipy.optimize import brentq

from bouncing_ball_beyond.contacts.balls import Ball, H, SpringDamper, brief, check_one_ball
from bouncing_ball_beyond.contacts.forces import SURFACE
from bouncing_ball_beyond.contacts.laws import ForceLaw
from bouncing_ball_beyond.contacts.named_laws import linear
from bouncing_ball_beyond.tables.table import PERIOD, SINE, Table, Values, check_table

LEVELS = np.append(np.linspace(0.875, 0.125, 7), [1e-3, 0.0])
"""Minima of the grip, divided by the grip at rest, through which the steady motion is followed.

The last two tell whether Λ still rises where the grip vanishes.
"""

RESIDUAL, MOST_NODES = 1e-8, 100_000
"""Largest relative residual of the steady motion, and maximum number of its nodes.

The threshold then has a relative error of about 1e-8. At 1e-9 laws with kinks need more nodes.
"""

NODES, LEAST_DAMPING = 256, 0.01
"""Number of nodes of the first guess, and its smallest damping ratio, which avoids resonances."""


def permanent_contact(ball: Ball, *, table: Table = SINE) -> float:
    """Find the largest Λ at which a ball that lies on the table stays in contact.

    Above this Λ the steady motion in contact is released. Other motions may coexist with it below:
    a ball that bounces may keep bouncing (:func:`.motion_of`).

    Parameters
    ----------
    ball : Ball
        One ball: its parameters are numbers.
    table : Table
        Waveform of the table, by default a sine.

    Returns
    -------
    float
        Λ, with a relative error of about 1e-8. If impacts are instantaneous, it is the Λ at which
        the table falls as fast as the ball, 1 for a sine (Eq. 9).

    Raises
    ------
    ValueError
        If the force depends on the speed at the start of the contact, or begins with a power below
        1. If the steady motion is not found. If Λ reaches a maximum before the grip is zero: the
        steady motion then ends in a saddle-node, and the ball jumps to another motion.

    Examples
    --------
    >>> from bouncing_ball_beyond import hunt_crossley
    >>> round(permanent_contact(hunt_crossley(stiffness=1000.0, damping=0.08)), 6)
    0.982176
    """
    check_one_ball(ball)
    check_table(table)
    if ball.below_table:
        raise ValueError(
            f"ball = {brief(ball)}: is not followed from impact to impact: ask the ball `of`"
        )
    if not ball.has_duration:
        return 1 / table.lift
    law: Any = (
        linear(ball.frequency_ratio, ball.zeta, release=ball.release)
        if isinstance(ball, SpringDamper)
        else ball
    )
    if "start_speed" in law.needs:
        raise ValueError(f"{law}: the force depends on the start of a contact that has no start")
    steady = _Steady(law, table)
    # At twice the depth forces of powers from 1 are at least twice as large, within rounding.
    if steady.force(2 * SURFACE, 0.0, 0.0) < 1.99 * steady.force(SURFACE, 0.0, 0.0):
        raise ValueError(f"{law}: the force begins with a power below 1, too steep at the surface")
    x, y, unknown = steady.guess(1 - LEVELS[0])
    before = 0.0
    for level in LEVELS:
        # The grip may have become weaker at another instant, and has the level there at a lower Λ.
        for _ in range(2):
            solution = solve_bvp(
                steady.rates,
                lambda start, end, unknown, level=level: steady.ends(start, end, unknown, level),
                x,
                y,
                unknown,
                tol=RESIDUAL,
                max_nodes=MOST_NODES,
            )
            if not solution.success:
                raise ValueError(
                    f"{law}: no steady motion in contact is found near Λ = {solution.p[1]:.4g}"
                )
            p, v = solution.sol(x)
            later = x[steady.grip(p, v, steady.load(x, solution.p)).argmin()]
            # Nodes that are kept from level to level become so many that they only round.
            y, unknown = solution.sol((x + later) % PERIOD), solution.p + np.array([later, 0.0])
        if unknown[1] < before:
            raise ValueError(
                f"{law}: the steady motion in contact ends, or is not the only one, near"
                f" Λ = {before:.4g}"
            )
        before = float(unknown[1])
    return before


class _Steady:
    """Equations of the steady motion: p and p′ as functions of the time s after the weakest grip.

    Attributes
    ----------
    law, table
        Contact law and waveform.
    given : dict
        Parameters of the force.
    static : float
        Penetration of the ball at rest, f(p, 0) = 1.
    held : float
        Grip at rest.

    The argument ``unknown`` of the methods has the phase of the table at s = 0, and Λ.
    """

    def __init__(self, law: ForceLaw, table: Table) -> None:
        self.law, self.table = law, table
        self.given = {**law.values, "u": 1.0}
        # At this depth a ball of the speed 1 is stopped under its weight, so f > 1.
        self.static = float(
            brentq(lambda p: self.force(p, 0.0, 1.0) - 1, 0.0, law.depth(1.0, 1.0), xtol=1e-300)
        )
        self.held = float(self.grip(self.static, 0.0, 1.0))

    def force(self, p: Values, v: Values, load: Values) -> Values:
        """Force f(p, p′). Iterations pass through p < 0, where most forces are not defined."""
        return self.law.force_at(np.maximum(p, 0.0), v, load, self.given)

    def grip(self, p: Values, v: Values, load: Values) -> Values:
        return p if self.law.release == "displacement" else self.law.grip(p, v, load, self.given)

    def load(self, s: Values, unknown: NDArray) -> Values:
        phase, amplitude = unknown
        return 1 + amplitude * self.table(s + phase, 2)

    def rates(self, s: Values, y: NDArray, unknown: NDArray) -> NDArray:
        """Return p′ and p″."""
        load = self.load(s, unknown)
        return np.array([y[1], load - self.force(y[0], y[1], load)])

    def ends(self, start: NDArray, end: NDArray, unknown: NDArray, level: float) -> NDArray:
        """Residuals: the grip and its rate at s = 0, and p and p′ after a period."""
        later = start + 1j * H * self.rates(0.0, start, unknown)
        grip = self.grip(later[0], later[1], self.load(1j * H, unknown))
        return np.array([grip.real - level * self.held, grip.imag / H, *(end - start)])

    def guess(self, share: float) -> tuple[NDArray, NDArray, NDArray]:
        """Return s, p and p′, and the unknowns, for a spring and a damper as near the static p.

        The grip falls by a share of the grip at rest.
        """
        stiffness = self.force(self.static + 1j * H, 0.0, 1.0).imag / H
        damping = self.force(self.static, 1j * H, 1.0).imag / H
        damping = max(damping, 2 * LEAST_DAMPING * np.sqrt(stiffness))
        s = np.linspace(0.0, 2 * np.pi, NODES, endpoint=False)
        k = np.arange(NODES // 2 + 1)
        waves = np.fft.rfft(self.table(s, 2)) / (stiffness - k * k + 1j * k * damping)
        p, v = np.fft.irfft([waves, 1j * k * waves])
        grip = self.grip(self.static + 1j * H * p, 1j * H * v, 1.0).imag
        weakest = grip.argmin()
        amplitude = -share * self.held * H / grip[weakest]
        y = amplitude * np.roll([p, v], -weakest, axis=1) + [[self.static], [0.0]]
        return np.append(s, 2 * np.pi), y[:, [*range(NODES), 0]], np.array([s[weakest], amplitude])

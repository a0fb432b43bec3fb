r"""How the end of a contact changes with its start: the linearised equations of its panels.

The derivatives are those of the collocation itself, so that they are exact for the computed motion:
one linear system for each panel, and one equation for the release. They are derivatives with
respect to (φ, v, Λ, w).
"""

from __future__ import annotations

import numpy as np

from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.loaded import under
from bouncing_ball_beyond.models.laws.panel import (
    IMAGINARY_STEP,
    Panel,
    Start,
    gauss_rule,
    grip_of,
    lever_of,
    load_of,
    slopes_of,
)


def at_end(
    law: ForceLaw, start: Start, panel: Panel, by: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The derivatives of (q, p′, t) at the ends of panels, and ∫ ∂F/∂p′ ds.

    They are derivatives with respect to (φ, v, Λ, w), and ``by`` are those at the start of the
    panels, shape (..., 3, 4). They solve the linearised equations of the collocation ::

        δF = F_q δq + F_u δp′ + F_t (δφ + δt) + F_Λ δΛ + F_w δw
    """
    count = len(panel.push)
    rule = gauss_rule(count)
    m = law.root
    q = panel.root[:-1].T
    angle = start.phase[:, np.newaxis] + panel.time[:-1].T
    lever = lever_of(m, q)
    bend = m * (m - 1) * q ** max(m - 2, 0)
    depth = panel.root[:-1] ** m
    rate = panel.rate[:-1]
    load = load_of(start, panel.time[:-1])
    slopes = slopes_of(under(law, load).force, depth, rate)

    def column(rows):
        return rows[:, :, np.newaxis]

    by_root = column(bend * panel.push.T / lever - lever * lever * slopes.by_penetration.T)
    by_rate = column(-lever * slopes.by_rate.T)
    # The share of the load that the force carries.
    carried = np.imag(under(law, load + IMAGINARY_STEP).force(depth, rate)) / IMAGINARY_STEP.imag
    felt = lever * (1 - carried.T)
    by_time = column(-felt * start.amplitude[:, np.newaxis] * np.cos(angle))
    step = panel.step[:, np.newaxis, np.newaxis]
    to_nodes = rule.integral[:-1]
    to_end = rule.integral[-1:]
    once = step * to_nodes
    twice = step * step * rule.twice
    # δp′ = δp′₀ + once δF, δq = δq₀ + once δp′, δt = δt₀ + bent δq
    root0, rate0, time0 = (by[:, np.newaxis, k] for k in range(3))
    free_root = root0 + step * rule.node * rate0
    known = by_root * free_root + by_rate * rate0 + by_time * time0
    matrix = np.eye(count) - by_root * twice - by_rate * once
    # Without a table's motion the load does not depend on the time.
    if m > 1 and start.amplitude.any():
        bent = once * bend[:, np.newaxis]
        known += by_time * (bent @ free_root)
        matrix -= by_time * (bent @ twice)
    known[:, :, 0] += by_time[:, :, 0]
    known[:, :, 2] -= felt * np.sin(angle)
    known[:, :, 3] += felt
    if law.feels_start_speed:
        known[:, :, 1] -= lever * law.by_start(depth, rate).T
    pushed = np.linalg.solve(matrix, known)
    of_root = free_root + step * step * (rule.twice @ pushed)
    of_rate = rate0 + step * (to_nodes @ pushed)
    ends = [
        root0 + step * (to_end @ of_rate),
        rate0 + step * (to_end @ pushed),
        time0 + step * (to_end @ (column(bend) * of_root)),
    ]
    return np.concatenate(ends, axis=1), (step * (to_end @ by_rate))[:, 0, 0]


def at_release(
    law: ForceLaw, start: Start, panel: Panel, by: np.ndarray, strain: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The derivatives of (D, p_e, p′_e) and the contraction, for panels that end at the release.

    ``by`` are the derivatives of (q, p′, t) at the ends of the panels, and ``strain`` is the
    integral of ∂F/∂p′ over the contacts.
    """
    m = law.root
    root = panel.root[-1]
    rate = panel.rate[-1]
    lever = lever_of(m, root)
    angle = start.phase + panel.time[-1]
    load = load_of(start, panel.time[-1])
    loaded = under(law, load)
    more = under(law, load + IMAGINARY_STEP)
    grip_by_root = np.imag(grip_of(loaded, m, root + IMAGINARY_STEP, rate)) / IMAGINARY_STEP.imag
    grip_by_rate = np.imag(grip_of(loaded, m, root, rate + IMAGINARY_STEP)) / IMAGINARY_STEP.imag
    grip_by_load = np.imag(grip_of(more, m, root, rate)) / IMAGINARY_STEP.imag
    grip_by_root = np.where(panel.surfaced, 1.0, grip_by_root)
    grip_by_rate = np.where(panel.surfaced, 0.0, grip_by_rate)
    grip_by_load = np.where(panel.surfaced, 0.0, grip_by_load)
    turning = -start.amplitude * np.cos(angle)
    # Up to the release the force is that of the law; the panel's F at its end is extrapolated
    # from the nodes, with an error of the order of the last Legendre coefficients and not of their
    # squares.
    force = loaded.force(root**m, rate)
    final = lever * (load - force)
    falls = grip_by_root * rate + grip_by_rate * final + grip_by_load * turning * lever
    # If the force has a step at the release, the rate of change of the grip has a step too.
    step = np.where(grip_by_rate == 0, 0.0, grip_by_rate * lever * force)
    by_root, by_rate, by_time = (by[:, k] for k in range(3))
    by_load = turning[:, np.newaxis] * by_time
    by_load += np.stack([turning, 0 * angle, -np.sin(angle), np.ones_like(angle)], axis=1)

    def column(row):
        return row[:, np.newaxis]

    moved = column(grip_by_root) * by_root + column(grip_by_rate) * by_rate
    moved = moved + column(grip_by_load) * by_load
    # How much later in s the release is.
    later = -moved / column(falls)
    ends = [
        by_time + column(lever) * later,
        column(lever) * (by_root + column(rate) * later),
        by_rate + column(final) * later,
    ]
    return np.stack(ends, axis=1), np.exp(strain) * falls / (falls + step)

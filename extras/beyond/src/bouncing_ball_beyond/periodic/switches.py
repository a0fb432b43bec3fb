"""Continue branches where the end of a contact switches between p = 0 and f = 0.

With the release "force", forces such as kp(1 + cp′) end a contact at p = 0, or earlier where f = 0.
At a *switch of a release* p and f vanish at the same time. The return map and the multipliers of an
orbit change smoothly there, so its stability does not change. But T may change as the square root
of the parameter: the branch has a corner, at which :func:`.march` stops.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root_scalar

from bouncing_ball_beyond.periodic.equations import OrbitEquations
from bouncing_ball_beyond.periodic.march import LONGEST_STEP, Start, newton, tangents, unit

SWITCH = "switch of a release"
"""Kind of the special orbits whose contact ends where p = 0 and f = 0."""

SWITCHED = 1e-7
"""Smallest distance of an orbit from a switch, and smallest f(p, p′)/f(p, 0) that is not 0."""

STEP = 1e-3
"""Length of the step across a switch, in units of `OrbitEquations.scales`."""


def _without_durations(equations: OrbitEquations, vectors: NDArray) -> NDArray:
    """Copy directions, shape (rows, N), and set the changes of all T to 0."""
    vectors = vectors.copy()
    vectors[:, 2 : equations.size : equations.unknowns] = 0.0
    return vectors


def at_surface(equations: OrbitEquations) -> OrbitEquations:
    """Return the equations of contacts that end at p = 0 alone."""
    law: Any = equations.ball
    return replace(equations, ball=law.at_surface())


def switch_of(equations: OrbitEquations, z: NDArray) -> tuple[NDArray, NDArray, NDArray] | None:
    """Find the switch of a release at which a branch of orbits with one impact stops.

    If p = 0 ended all contacts, the branch would pass the switch smoothly, and f(p, p′)/f(p, 0) at
    the end would change its sign. So the switch is found on the branch of these contacts.

    ``z`` contains the orbits of the branch, shape (points, N). Returns the orbits before the
    switch, the switch, shape (N,), and the direction of the branch there, shape (N,); or None.
    """
    if equations.kind or equations.impacts > 1 or not equations.ball.has_two_ends:
        return None
    before = z[equations.surface_share(z) > -SWITCHED]
    surface = at_surface(equations)
    near = newton(surface, z[-1:])
    if not (near.converged[0] and len(before)):
        return None
    along = tangents(surface, near.z)

    def orbit_at(step: float) -> NDArray:
        return newton(surface, near.z + step * along, along).z

    zero = root_scalar(lambda step: surface.surface_share(orbit_at(step))[0], x0=0.0, x1=1e-4)
    switch = orbit_at(zero.root)
    units = equations.scales(switch)
    moved = _without_durations(equations, (switch - before) / units)
    distance = np.linalg.norm(moved, axis=1)
    if not (zero.converged and distance[-1] < LONGEST_STEP and distance.max() > SWITCHED):
        return None
    nearest = moved[distance > SWITCHED][-1]
    return before, switch[0], along[0] * np.sign((along / units)[0] @ nearest)


def beyond_switch(
    equations: OrbitEquations, switch: NDArray, direction: NDArray, goal: NDArray
) -> Start:
    """Start branches of contacts with the other end at switches, shape (rows, N).

    T is computed, because only the times and speeds of impacts change smoothly. The planes of
    Newton's method contain the direction of T.
    """
    switch, direction = np.atleast_2d(switch, direction)
    units = equations.scales(switch)
    ahead = unit(direction / units)
    guess = switch + STEP * ahead * units
    x, ball, amplitude, table = equations.split(guess)
    T = ball.first_release(x[..., 0], x[..., 1], amplitude, table=table)
    guess[:, 2 : equations.size : equations.unknowns] = T
    start = newton(equations, guess, _without_durations(equations, ahead / units))
    reasons = np.where(start.converged, "", "no orbit with the other end is found")
    return Start(equations, start.z, start.tangent, goal, reasons, STEP, switch)

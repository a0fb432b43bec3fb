"""The two models once more, sharing no code with the package: references for its tests.

The motion in contact comes from `scipy.integrate.solve_ivp`, or from the exponential of the matrix
of its linear equation, which has no special case at resonance. In both, the time is θ = ϖ s and the
displacement q = ϖδ, so that the numbers are of order one for a contact of any stiffness:

    dq/dθ = δ′,  dδ′/dθ = -q - 2ζδ′ + (Λ sin(s + φ) - 1)/ϖ.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

ACCURACY = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}


def restitution_to_damping(r):
    """Eq. 16, from the logarithmic decrement of half an oscillation, ln r = -πζ/√(1 - ζ²)."""
    return np.sin(np.arctan(-np.log(r) / np.pi))


def lag(ratio, zeta, release):
    """κ of the condition δ + κδ′ = 0 that ends a contact."""
    return 2 * zeta / ratio if release == "force" else 0.0


def transfer(ratio, zeta, duration):
    """The matrices that take (ϖδ, δ′, w, w′, 1) from the start of the contact to times after it."""
    duration = np.asarray(duration, dtype=float)
    rates = np.zeros((5, 5))
    rates[0, 1] = 1
    rates[1] = -1, -2 * zeta, 1 / ratio, 0, -1 / ratio
    rates[2, 3] = 1 / ratio
    rates[3, 2] = -1 / ratio
    # Scaling and squaring: the series of the exponential, for a matrix of norm below 1/4, has the
    # remainder 0.25¹³/13! < 1e-17. `scipy.linalg.expm` takes its matrices one by one.
    norm = np.abs(rates).sum(axis=1).max() * ratio * np.max(duration)
    halvings = max(0, int(np.ceil(np.log2(4 * norm + 1))))
    step = rates * (ratio * duration / 2**halvings)[..., np.newaxis, np.newaxis]
    total = np.broadcast_to(np.eye(5), step.shape)
    for order in range(12, 0, -1):
        total = np.eye(5) + step @ total / order
    for _ in range(halvings):
        total = total @ total
    return total


def orbit(n, ratio, zeta, release, duration):
    """The n-T orbits whose contact has a given duration, as (Λ, φ, z′_i, ϖτ_b), shape (4, ...).

    Release, landing and velocity are three linear equations for X = Λ cos φ, Y = Λ sin φ and
    u = δ′_i.
    """
    duration = np.asarray(duration, dtype=float)
    flight = 2 * np.pi * n - duration
    # The start (ϖδ, δ′, w, w′, 1) = (0, u, Y, X, 1) by X, Y, u and 1.
    start = np.zeros((5, 4))
    start[3, 0] = start[2, 1] = start[1, 2] = start[4, 3] = 1
    end = transfer(ratio, zeta, duration) @ start
    gap = end[..., 0, :] / ratio
    rate = end[..., 1, :]
    velocity = rate + end[..., 3, :]
    release = ratio * (gap + lag(ratio, zeta, release) * rate)
    landing = gap + end[..., 2, :] - start[2] + flight[..., np.newaxis] * velocity
    landing[..., 3] -= flight**2 / 2
    repeating = velocity - start[3] - start[1]
    repeating[..., 3] -= flight
    rows = np.stack([release, landing, repeating], axis=-2)
    x, impact_height, u = np.moveaxis(np.linalg.solve(rows[..., :3], -rows[..., 3:])[..., 0], -1, 0)
    return np.stack(
        [np.hypot(x, impact_height), np.arctan2(impact_height, x), u + x, ratio * duration]
    )


def monodromy(n, ratio, zeta, release, duration):
    """The change of (z, z′) over a cycle, shape (..., 2, 2); it has the multipliers of the orbit.

    It is the product of the free motions in contact and flight, and of the saltation matrices
    1 + (jump of the rates)(gradient of the event)ᵀ/(rate of the event) at the events between them.
    At the landing z″ jumps by -2ζϖδ′, and δ has the rate δ′. At a release at δ = 0 it jumps back;
    where the force vanishes it does not jump.
    """
    duration = np.asarray(duration, dtype=float)
    scale = np.array([[1, ratio], [1 / ratio, 1]])
    contact = transfer(ratio, zeta, duration)[..., :2, :2] / scale
    kick = 2 * zeta * ratio
    landing = np.array([[1, 0], [-kick, 1]])
    leaving = np.array([[1, 0], [kick if release == "displacement" else 0, 1]])
    flight = np.zeros((*duration.shape, 2, 2))
    flight[..., 0, 0] = flight[..., 1, 1] = 1
    flight[..., 0, 1] = 2 * np.pi * n - duration
    return landing @ flight @ leaving @ contact


def test_functions(n, ratio, zeta, release, duration):
    """1 - trace + determinant and 1 + trace + determinant, which vanish at the bifurcations."""
    trace = np.trace(monodromy(n, ratio, zeta, release, duration), axis1=-2, axis2=-1)
    determinant = np.exp(-2 * zeta * ratio * np.asarray(duration))
    return 1 - trace + determinant, 1 + trace + determinant


test_functions.__test__ = False


def roots(function, grid):
    """The zeros of a function of an array, bracketed by the points of a grid."""
    values = function(grid)
    brackets = np.flatnonzero(values[:-1] * values[1:] < 0)
    return [brentq(function, grid[i], grid[i + 1], xtol=1e-16) for i in brackets]


def lowest(function):
    """The lowest value of a function on the open interval from 0 to 1, without a hundredth at each
    end, from samples and further samples round the lowest.
    """
    part = np.linspace(0.01, 0.99, 201)
    for _ in range(2):
        middle = np.clip(np.argmin(function(part)), 1, 199)
        part = np.linspace(part[middle - 1], part[middle + 1], 201)
    return function(part).min()


@dataclass
class Contact:
    """A contact by integration: its duration, δ and δ′ at its end, and samples of δ and δ′."""

    duration: float
    gap: float
    rate: float
    times: np.ndarray
    gaps: np.ndarray
    rates: np.ndarray


def integrate_contact(ratio, zeta, release, amplitude, phase, u, weight=1.0, duration=None):
    """Integrate Eq. 11 from δ = 0, δ′ = u to the release, or over a given duration."""
    kappa = lag(ratio, zeta, release) * ratio

    def rates(theta, state):
        force = (amplitude * np.sin(theta / ratio + phase) - weight) / ratio
        return [state[1], force - state[0] - 2 * zeta * state[1]]

    def released(theta, state):
        return state[0] + kappa * state[1]

    released.terminal = True
    released.direction = 1
    last = 200 * ratio if duration is None else ratio * duration
    event = released if duration is None else None
    path = solve_ivp(
        rates, (0, last), [0.0, u], events=event, dense_output=True, max_step=0.5, **ACCURACY
    )
    theta = path.t[-1]
    state = path.y[:, -1]
    if duration is None:
        # The event lies on an interpolant, which is less accurate than the steps. Integrate to its
        # time once more; a step of Newton's method takes the rest away.
        state = solve_ivp(rates, (0, theta), [0.0, u], **ACCURACY).y[:, -1]
        speed = np.array(rates(theta, state))
        late = released(theta, state) / (speed[0] + kappa * speed[1])
        theta = theta - late
        state = state - late * speed
    samples = np.linspace(0, theta, 400)
    dense = path.sol(np.minimum(samples, path.t[-1]))
    return Contact(theta / ratio, state[0] / ratio, state[1], samples / ratio, *dense)


@dataclass
class Cycle:
    """A contact and the flight after it.

    ``contact`` is the contact, ``bounce`` the velocity at its end, ``time`` the duration of both,
    and ``velocity`` that of the ball at the next landing. ``times``, ``heights`` and ``velocities``
    are 400 samples in contact and 400 in flight.
    """

    contact: Contact
    bounce: float
    time: float
    velocity: float
    times: np.ndarray
    heights: np.ndarray
    velocities: np.ndarray

    def greatest_height(self):
        """The greatest height, by a parabola through the three samples round the largest."""
        greatest = self.heights.max()
        for part in np.split(self.heights, 2):
            middle = np.clip(np.argmax(part), 1, 398)
            before, top, after = part[middle - 1 : middle + 2]
            if top >= max(before, after):
                summit = top - (after - before) ** 2 / (8 * (before - 2 * top + after))
                greatest = max(greatest, summit)
        return greatest


def cycle(ratio, zeta, release, amplitude, phase, velocity):
    """Integrate a contact from its start to its release, and fly to the next landing."""
    u = velocity - amplitude * np.cos(phase)
    contact = integrate_contact(ratio, zeta, release, amplitude, phase, u)
    height = contact.gap + amplitude * np.sin(phase + contact.duration)
    bounce = contact.rate + amplitude * np.cos(phase + contact.duration)
    kappa = lag(ratio, zeta, release)
    flight = first_landing(amplitude, phase + contact.duration, height, bounce, kappa)
    pressed = phase + contact.times
    flying = np.linspace(0, flight, 400)
    return Cycle(
        contact=contact,
        bounce=bounce,
        time=contact.duration + flight,
        velocity=bounce - flight,
        times=np.concatenate([contact.times, contact.duration + flying]),
        heights=np.concatenate(
            [
                contact.gaps / ratio + amplitude * np.sin(pressed),
                height + bounce * flying - flying**2 / 2,
            ]
        ),
        velocities=np.concatenate([contact.rates + amplitude * np.cos(pressed), bounce - flying]),
    )


def first_landing(amplitude, phase, height, velocity, kappa=0.0):
    """Duration of a flight from a height until it ends, looked for in steps of about 2e-3.

    It ends where δ falls through zero. After a force release δ is negative at first; if δ + κδ′
    falls through zero before the ball has left the table, the contact presses the ball again, which
    is an end, too.
    """

    def gap(s):
        return height + velocity * s - s**2 / 2 - amplitude * np.sin(phase + s)

    def outside(s):
        rate = velocity - s - amplitude * np.cos(phase + s)
        return np.maximum(gap(s), gap(s) + kappa * rate) if kappa else gap(s)

    last = velocity + np.sqrt(velocity**2 + 2 * (height + amplitude)) + 1
    grid = np.linspace(0, last, 2 + int(last / 2e-3))
    values = outside(grid)
    # The first point is the release itself, where rounding errors decide.
    first = 1 + np.flatnonzero((values[1:-1] > 0) & (values[2:] <= 0))[0]
    return brentq(outside, grid[first], grid[first + 1], xtol=1e-15)

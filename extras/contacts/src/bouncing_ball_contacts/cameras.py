"""Flights of a ball in a film: what a camera makes of them, and the speeds at the impacts.

A pinhole camera that stands still shows a point at the height z of a straight path at::

    s = (a z + b)/(c z + 1)

so tilt, roll and distance are one number c. In units of the range of the film, and counted from the
floor, a flight p(t) = A + B t - g t²/2 is seen at::

    s = p/(1 + c p + e t),    t = t_frame - ρ s

where e is the growth of the distance of a ball that drifts away from the camera, and ρ the time in
which a rolling shutter reads the rows of the range. All flights of a film have one g, c, ρ and e.
What the flights do not tell of c, ρ and e, priors do: their widths contain what cameras have.

At an impact both speeds have the same ds/dz, so that r needs no scale. Between two impacts the
speeds are those with which a ball leaves a floor and comes back to it, which moves evenly
in the picture meanwhile: without drag r is then the ratio of the durations of two flights, whatever
the camera does.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import sparse, special

from bouncing_ball_contacts.flights import fall_of, impact_of, meeting_of
from bouncing_ball_contacts.units import STANDARD_GRAVITY, Array

# Standard deviations of c, of e in flights of the range, and of ρ in steps of the frames or 20 ms.
_BEND = 0.3
_RECEDE = 0.1
_READ = 0.6
_SLOWEST_READ = 0.02
_GLOBALS = 4
KINK = 0.4
"""Share of its sideways speed that a ball without spin loses at most, a hollow one that rolls."""
# Probability below which a misfit is not one by chance.
_CHANCE = 0.003


class Film(NamedTuple):
    """Speeds of a film, and what its errors do to them.

    Attributes
    ----------
    speeds
        In m/s before and after each impact, shape (n, 2).
    readings, of_speed
        What each independent error of the film, of one standard deviation, adds to ln r and to
        ln v, shape (n, error).
    floor
        Speed in m/s at which the floor rises in the picture; 0 of one impact.
    misfit
        Factor by which errors are larger than those of positions, because the flights are not quite
        those of one camera; otherwise 1.
    """

    speeds: Array
    readings: Array
    of_speed: Array
    floor: float
    misfit: float


def _flights(tracks: Sequence[Array]) -> tuple[Array, Array, Array, Array]:
    """Return flight, time and position of all positions, and the flight after each impact.

    Tracks of successive impacts share a flight.
    """
    begins, ends = np.array([[track[0, 0], track[-1, 0]] for track in tracks]).T
    gaps = np.concatenate([[0], np.cumsum(begins[1:] > ends[:-1])])
    afters = 1 + np.arange(len(tracks)) + gaps
    rows = [
        np.column_stack([after - 1 + track[:, 2], track[:, :2]])
        for after, track in zip(afters, tracks, strict=True)
    ]
    flight, t, s = np.unique(np.concatenate(rows), axis=0).T
    return flight.astype(int), t, s, afters


def _slope(t: Array, y: Array) -> float:
    """Return the slope of the line through points; 0 of one point."""
    since = t - t.mean()
    return float(since @ y / max(since @ since, 1e-9))


def _misfit(flight: Array, since: Array, left: Array, degrees: float) -> float:
    """Return by how much the flights deviate more than positions do; 1 if that may be by chance.

    Polynomials of each flight, of the fourth degree, take what a camera leaves of ``left``.
    """
    squares = 0.0
    free = 0.0
    for index in range(flight.max() + 1):
        t, y = since[flight == index], left[flight == index]
        if len(t) > 5:
            y = y - np.polyval(np.polyfit(t, y, 4), t)
            free += len(t) - 5
        squares += float(y @ y)
    more = degrees - free
    if more < 1 or free < 1:
        return 1.0
    ratio = (float(left @ left) / max(squares, 1e-18) - 1) * free / more
    return math.sqrt(ratio) if special.fdtrc(more, free, max(ratio, 0.0)) < _CHANCE else 1.0


def _seen(
    parameters: Array, flight: Array, since: Array, later: Array, y: Array, drag: float
) -> tuple[Array, Array]:
    """Return where positions of flights are seen, and the derivatives of that, shape (n, 6).

    The derivatives are with respect to gravity, c, e, ρ, and the start and slope of each flight.
    """
    gravity, bend, recede, read = parameters[:_GLOBALS]
    start, slope = parameters[_GLOBALS:].reshape(-1, 2)[flight].T
    top = slope / gravity
    fallen, speed = fall_of(since - read * y - top, drag)
    p = start + gravity * (top**2 / 2 - fallen)
    depth = 1 + bend * p + recede * later
    of_p = np.column_stack(
        [
            -(top**2) / 2 - fallen - speed * top,
            np.zeros_like(p),
            np.zeros_like(p),
            gravity * speed * y,
            np.ones_like(p),
            top + speed,
        ]
    )
    derivatives = ((1 + recede * later) / depth**2)[:, None] * of_p
    derivatives[:, 1] = -((p / depth) ** 2)
    derivatives[:, 2] = -p * later / depth**2
    return p / depth, derivatives


def _fitted(
    flight: Array,
    since: Array,
    later: Array,
    y: Array,
    gravity: float,
    priors: Array,
    drag: float,
) -> tuple[Array, Array, float]:
    """Fit flights and camera: return the numbers that `_seen` takes, their errors, and the misfit.

    The fit is one of least squares with the priors of the camera, by Gauss and Newton, from a first
    ``gravity``. ``priors`` are 1/σ² of c, e and ρ. A row of the errors is what an independent error
    of one standard deviation adds to the numbers.

    Raises
    ------
    LinAlgError
        If the fit does not converge, because no ball has such flights.
    """
    n = len(y)
    places = np.column_stack(
        [
            *np.repeat([range(_GLOBALS)], n, axis=0).T,
            _GLOBALS + 2 * flight,
            _GLOBALS + 1 + 2 * flight,
        ]
    )
    precision = np.zeros(_GLOBALS + 2 * (flight.max() + 1))
    precision[1:_GLOBALS] = priors
    parameters = np.zeros(len(precision))
    parameters[0] = gravity
    noise = 1.0
    # The last steps move nothing any more.
    for _ in range(12):
        seen, derivatives = _seen(parameters, flight, since, later, y, drag)
        jacobian = sparse.csr_matrix(
            (derivatives.ravel(), places.ravel(), np.arange(n + 1) * places.shape[1]),
            shape=(n, len(parameters)),
        )
        left = y - seen
        normal = (jacobian.T @ jacobian).toarray()
        inverse = np.linalg.inv(normal / noise**2 + np.diag(precision))
        move = inverse @ (jacobian.T @ left / noise**2 - precision * parameters)
        parameters = parameters + move
        used = len(parameters) - np.sum(np.diag(inverse) * precision)
        noise = math.sqrt(max(float(left @ left) / max(n - used, 1.0), 1e-18))
        if not (noise < math.inf and parameters[0] > 0):
            raise np.linalg.LinAlgError("no ball has such flights")
    misfit = _misfit(flight, since, left, n - used)
    return parameters, misfit * np.linalg.cholesky(inverse).T, misfit


def _on_one_floor(state: Array, changes: Array, impacts: int) -> tuple[Array, Array]:
    """Return a state and its changes by errors, given that the floor moves evenly in the picture.

    The last numbers of a state, one for each impact, are the distances of the floors from a line.
    They vanish but for their errors, and for the smallest scatter with which they are not larger
    than expected (R. C. Paule, J. Mandel, J. Res. Natl. Bur. Stand. 87 (1982) 377).
    """
    ways, sizes, modes = np.linalg.svd(changes[:, -impacts:], full_matrices=False)
    # Any two floors lie on a line.
    count = max(impacts - 2, 0)
    ways, sizes, modes = ways[:, :count], sizes[:count], modes[:count]
    apart = modes @ state[-impacts:]
    scatters = np.array([0.0, *np.geomspace(1e-9, 1.0, 200)])[:, None]
    expected = np.sum(apart**2 / (sizes**2 + scatters**2), axis=1) <= len(sizes)
    total = np.hypot(sizes, scatters[np.argmax(expected)])
    state = state - changes.T @ ways @ (sizes * apart / total**2)
    left = np.sqrt(np.maximum(1 - (sizes / total) ** 2, 0.0))
    return state, changes - ways @ ((1 - left)[:, None] * (ways.T @ changes))


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def film_of(tracks: Sequence[Array], drag: float = 0.0, has_clock: bool = True) -> Film:
    """Fit the flights of a film with one gravity and one camera, and return its speeds.

    The scale of the speeds is gravity. Without a clock positions are in m, and times are scaled
    until gravity is the standard one.

    Parameters
    ----------
    tracks : sequence of arrays
        Of each impact, as of `impact_of`.
    drag : float
        ρ C A/(2 m) in 1/m.
    has_clock : bool
        Whether times are true.
    """
    for _ in range(1 if has_clock else 5):
        first = np.array([impact_of(track, drag) for track in tracks])
        slow = 1.0 if has_clock else math.sqrt(max(first[:, 2].mean() / STANDARD_GRAVITY, 1e-9))
        tracks = [track * [slow, 1, 1] for track in tracks]
    flight, t, s, after = _flights(tracks)
    down, up, gravities, _, meets, floors, _ = first.T
    none = np.zeros((len(after), 1))
    # No ball has such flights with this drag.
    unlike = Film(np.zeros((len(after), 2)), none, none, 0.0, 1.0)
    if min(down.min(), up.min(), gravities.min()) <= 0:
        return unlike
    span = float(np.ptp(s))
    # Drag is that of a ball above its floor, wherever the floor moves in the picture.
    drifts = _slope(meets, floors)
    y = (s - floors.mean() - drifts * (t - meets.mean())) / span
    middle = np.bincount(flight, t) / np.bincount(flight)
    since = t - middle[flight]
    lasts = math.sqrt(8 * span / gravities.mean())
    later = (t - t.mean()) / lasts
    reads = _READ * max(float(np.median(np.diff(np.unique(t)))), _SLOWEST_READ)
    priors = 1 / np.square([_BEND, _RECEDE, reads])
    try:
        parameters, errors, misfit = _fitted(flight, since, later, y, 8 / lasts**2, priors, drag)
    except np.linalg.LinAlgError:
        return unlike
    shared = np.flatnonzero(np.diff(after) == 1)
    pairs = np.array([after - 1, after])
    away = middle[after] - middle[pairs]

    def state_of(parameters: Array) -> Array:
        """Return the speeds before and after, that of the floor, and floors less their line."""
        gravity = parameters[0]
        start, slope = parameters[_GLOBALS:].reshape(-1, 2).T
        starts = start[pairs] + slope[pairs] * away - gravity * away**2 / 2
        meet, floor, *speeds = meeting_of(starts, slope[pairs] - gravity * away, gravity, drag)
        time = middle[after] + meet
        moves = _slope(time, floor)
        floors = np.full((2, len(after)), moves)
        floors[1, shared] = floors[0, shared + 1] = (np.diff(floor) / np.diff(time))[shared]
        both = np.array(speeds) + floors * [[1], [-1]]
        scale = STANDARD_GRAVITY / gravity
        apart = floor - floor.mean() - moves * (time - time.mean())
        return np.concatenate([*(scale * both), [scale * (moves + drifts / span)], apart])

    state = state_of(parameters)
    changes = np.array(
        [(state_of(parameters + error) - state_of(parameters - error)) / 2 for error in errors]
    )
    if not (state[: 2 * len(after)].min() > 0 and np.isfinite(changes).all()):
        return unlike
    state, changes = _on_one_floor(state, changes, len(after))
    speeds = state[: 2 * len(after)].reshape(2, -1)
    moves = state[2 * len(after)]
    error = np.linalg.norm(changes[:, 2 * len(after)])
    drifts = math.sqrt(max(moves**2 - error**2, 0.0))
    # At both ends of a film no floor tells how fast the ball drifts in the picture.
    is_end = np.ones((2, len(after)))
    is_end[1, shared] = is_end[0, shared + 1] = 0
    at_begin, at_end = (np.diag(kink) for kink in is_end * KINK * drifts)
    of_speeds = changes[:, : 2 * len(after)].T.reshape(2, len(after), -1) / speeds[:, :, None]
    of_before = np.column_stack([of_speeds[0], at_begin / speeds[0], 0 * at_end])
    of_up = np.column_stack([of_speeds[1], 0 * at_begin, at_end / speeds[1]])
    return Film(speeds.T, of_up - of_before, of_before, moves, misfit)

r"""Contacts of any law: their ends, and their motion at any time.

Each function takes starts of contacts as arrays that broadcast, and lets them
:mod:`march <bouncing_ball_beyond.models.laws.march>` to their release.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.march import MOST_PANELS, ContactEnds, march, march_through
from bouncing_ball_beyond.models.laws.panel import Start, selected

# A time counts as the end of the contact if less than this part of the contact remains.
_END = 1e-12


def states(
    law: ForceLaw, start: Start, end: Sequence[np.ndarray], time: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ at times within contacts whose ends (D, p_e, p′_e) are known.

    All arrays have one entry per contact.
    """
    inside = np.flatnonzero((time > 0) & (time < (1 - _END) * end[0]))
    laws, own = selected(inside, law, start)
    rows, contact = np.unique(np.array(own), axis=1, return_inverse=True)
    if laws.shape or 2 * rows.shape[1] > inside.size:
        found = march(laws, own, MOST_PANELS, time[inside])
    else:
        found = march_through(laws, Start(*rows), contact, time[inside], MOST_PANELS)
    depth = np.where(time > 0, end[1], start.depth)
    rate = np.where(time > 0, end[2], start.rate)
    depth[inside] = found.penetration
    rate[inside] = found.rate
    return depth, rate


def _row(law: ForceLaw, *columns: ArrayLike) -> tuple[ForceLaw, list[np.ndarray], tuple[int, ...]]:
    """The laws and the columns, broadcast and flattened, and the shape to which they broadcast."""
    arrays = [np.asarray(x, dtype=float) for x in columns]
    shape = np.broadcast_shapes(law.shape, *(x.shape for x in arrays))
    return law.flat(shape), [np.broadcast_to(x, shape).reshape(-1) for x in arrays], shape


def contacts(
    law: ForceLaw,
    speed: ArrayLike,
    phase: ArrayLike = 0.0,
    amplitude: ArrayLike = 0.0,
    weight: ArrayLike = 1.0,
) -> ContactEnds:
    """Contacts that start at p = 0 with speed v > 0 at a phase φ of the table.

    Parameters
    ----------
    law : ForceLaw
        One law, or one for each contact.
    speed, phase, amplitude : array_like
        v, φ and Λ.
    weight : array_like
        The weight w: 1, or 0 for a free impact.

    Returns
    -------
    ContactEnds
        Arrays of the shape to which the arguments broadcast. They are NaN where v ≤ 0, and where
        the ball is not released within a dozen oscillations.

    Examples
    --------
    A quarter of the energy is left after an impact with r = 1/2:

    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji, tsuji_damping
    >>> free = contacts(Tsuji(100.0, tsuji_damping(0.5)), 3.0, weight=0.0)
    >>> round(float(free.rate), 12)
    -1.5
    """
    laws, (v, phi, lam, w), shape = _row(law, speed, phase, amplitude, weight)
    start = Start(depth=0 * v, rate=np.where(v > 0, v, np.nan), phase=phi, amplitude=lam, weight=w)
    found = march(laws, start, differentiate=True)
    return ContactEnds(*(x.reshape((*shape, *x.shape[1:])) for x in found))


def path(
    law: ForceLaw,
    found: ContactEnds,
    time: ArrayLike,
    speed: ArrayLike,
    phase: ArrayLike = 0.0,
    amplitude: ArrayLike = 0.0,
    weight: ArrayLike = 1.0,
) -> tuple[np.ndarray, np.ndarray]:
    """p and p′ a time after the start of contacts, with 0 ≤ time ≤ D.

    Parameters
    ----------
    law : ForceLaw
    found : ContactEnds
        The result of :func:`contacts` for these starts.
    time : array_like
        The times; they may have additional leading axes.
    speed, phase, amplitude, weight : array_like
        The starts, as in :func:`contacts`.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> law = SpringDamper(np.pi, 0.0)
    >>> depth, rate = path(law, contacts(law, np.pi, weight=0.0), 0.5, np.pi, weight=0.0)
    >>> round(float(depth), 12), abs(round(float(rate), 12))
    (1.0, 0.0)
    """
    ends = found.duration, found.penetration, found.rate
    start = speed, phase, amplitude, weight
    columns = (time, *ends, *start)
    laws, flat, shape = _row(law, *columns)
    t, duration, end_depth, end_rate, v, phi, lam, w = flat
    start = Start(depth=np.zeros_like(t), rate=v, phase=phi, amplitude=lam, weight=w)
    depth, rate = states(laws, start, (duration, end_depth, end_rate), t)
    return depth.reshape(shape), rate.reshape(shape)

r"""The contact that suits a time step: the one whose r is nearest to the one asked for in a drop.

Two errors oppose each other. A stiff contact takes few steps, so that its r depends on where in a
step the ball meets the wall; a compliant one is long, and gravity, which acts in it, takes
``2ζ(1 + r) g/(ωv)`` of r. Without gravity the softest contact would be the best one.
"""

from collections.abc import Callable

import numpy as np

from bouncing_ball_contacts.engines.impacts import FEWEST

# Steps in the contacts that are tried, in ratios of 3 %: the error is flat around its least value.
_MOST = 512
_RATIO = 1.03
# Damping of a step or of a load is made up for by less than this multiple of that of the contact.
_MOST_DAMPING = 3.0
# Each grid of dampings lies between the neighbours of the best one of the grid before.
_GRID = 13
_GRIDS = 4
# Beyond these multiples of the best contact and of its error, gravity only takes more.
_FAR = 2.0


def stiffness_of_least_error(
    found: Callable[[float, float], np.ndarray], restitution: float, one: float
) -> float:
    """The stiffness in N/m, with three digits, of which the greatest error of r is the least.

    Parameters
    ----------
    found : callable
        √(h′/h) at all instants within a step, of a stiffness whose contact takes so many steps.
    restitution : float
        The r that was asked for.
    one : float
        The stiffness whose contact takes one step; N steps are taken by ``one/N²``.

    Examples
    --------
    >>> error = lambda stiffness, steps: np.array([0.75 + 1 / steps - steps / 400])
    >>> stiffness_of_least_error(error, 0.75, 4e5)
    1000.0
    """
    best = None
    least = np.inf
    fewest = float(FEWEST)
    steps = fewest
    while steps <= _MOST:
        stiffness = float(f"{one / steps**2:.3g}")
        restitutions = found(stiffness, steps)
        error = float(np.abs(restitutions - restitution).max())
        if best is None or error < least:
            best = stiffness
            least = error
            fewest = steps
        # The error of a ball that does not rebound is r, which may be less than that multiple.
        if steps > _FAR * fewest and (error > _FAR * least or not restitutions.any()):
            break
        steps *= _RATIO
    assert best is not None
    return best


def damping_of_least_error(error: Callable[[float], float], damping: float) -> float:
    """The damping, with three digits, of which the greatest error of r is the least.

    Parameters
    ----------
    error : callable
        The greatest error of r with a damping; it has bends and jumps.
    damping : float
        That of the contact with small steps, in any unit.

    Examples
    --------
    >>> damping_of_least_error(lambda damping: abs(damping - 1.234), 2.0)
    1.23
    >>> damping_of_least_error(lambda damping: damping, 2.0)
    0.0
    """
    low = 0.0
    high = _MOST_DAMPING * damping
    for _ in range(_GRIDS):
        tried = np.linspace(low, high, _GRID).tolist()
        best = min(tried, key=error)
        width = tried[1] - tried[0]
        low = max(0.0, best - width)
        high = best + width
    return float(f"{best:.3g}")

"""The 1-T orbits with a long contact, into which permanent contact continues.

At Λ_SD permanent contact ends, and a 1-T orbit with a short flight T and a
contact that lasts D = 2π - T begins (``docs/closed-form.md``, section 5). The orbits with more
flights that follow are those of :mod:`bouncing_ball.attractors.rattling`. In a compliant contact
these orbits are one family with those of a short contact.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit

# Orbits from the saddle-node to Λ_SD that must all be admissible; the inadmissible part
# opens with the root of the distance in ϖ, so that six hundred of them resolve 10⁻⁶.
_JOINT_SAMPLES = 600
# These orbits start so far in time from the saddle-node, on its unstable side, and end at this
# flight time.
_TO_SIDE, _SHORT = 1e-3, 0.02
# Width in ϖ at which the bisection for the joining ratio stops.
_CLOSE = 1e-8


def orbit_with_flight(contact: SpringDamper, flight_time: ArrayLike) -> SpringDamperOrbit:
    """The 1-T orbits with a given time of flight T in (0, 2π).

    Contact and flight times broadcast.

    Examples
    --------
    >>> orbit = orbit_with_flight(SpringDamper.from_restitution(0.85, 2.0), 1.0)
    >>> float(orbit.flight_time.round(12)), bool(orbit.is_stable())
    (1.0, True)
    """
    duration = 2 * np.pi - np.asarray(flight_time)
    excess = duration * contact.damped_frequency - contact.free_angle
    return SpringDamperOrbit.on_branch(excess, contact, 1)


def joined(contact: SpringDamper) -> np.ndarray:
    """Whether all orbits from the saddle-node to Λ_SD are admissible, for each contact, shape (m,).

    If they are, the unstable side of the branch with a short contact leads to the orbits
    with a long one. False where the branch has no saddle-node. It is decided on 600 orbits
    between the two, because the inadmissible part opens with the root of the distance in ϖ.

    Examples
    --------
    >>> joined(SpringDamper.from_restitution(0.85, np.array([1.9, 3.0]))).tolist()
    [True, False]
    """
    node = SpringDamperModel(contact).saddle_node(1).contact_duration
    found = np.isfinite(node)
    if found.any():
        longest = 2 * np.pi - node[found] - _TO_SIDE
        times = np.linspace(longest, _SHORT, _JOINT_SAMPLES)
        found[found] = orbit_with_flight(contact[found], times).is_admissible().all(axis=0)
    return found


def joining_ratio(
    damping_ratio: ArrayLike, release: Release, low: float, high: float
) -> np.ndarray:
    """The ϖ above which the families with a short and a long contact are not connected.

    Parameters
    ----------
    damping_ratio : array_like
        ζ.
    release : Release
    low, high : float
        Range of ϖ in which the transition is looked for.

    Returns
    -------
    ndarray
        Of the shape of ζ; NaN unless the families are connected at ``low`` and not at ``high``.
    """
    zeta = np.atleast_1d(np.asarray(damping_ratio, dtype=float))

    def together(ratio: np.ndarray) -> np.ndarray:
        return joined(SpringDamper(ratio, zeta, release))

    below, above = np.full(zeta.shape, low), np.full(zeta.shape, high)
    parting = together(below) & ~together(above)
    for _ in range(math.ceil(math.log2((high - low) / _CLOSE)) if parting.any() else 0):
        middle = (below + above) / 2
        here = together(middle)
        below, above = np.where(here, middle, below), np.where(here, above, middle)
    return np.where(parting, below, np.nan).reshape(np.shape(damping_ratio))

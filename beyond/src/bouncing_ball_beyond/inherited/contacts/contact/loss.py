r"""The damping ratio of a contact whose loss is given.

A free impact ends at the angle π - 2α (:mod:`bouncing_ball_beyond.models.damping`), from which ζ
follows for a given r. A drop test is a drop with gravity onto a table at rest, from which ζ is
fitted (:mod:`bouncing_ball_beyond.inherited.contacts.contact.drop_test`) and which depends on the
stiffness for this reason. For a contact law gravity is neglected, and r = √(h′/h).
"""

import math
from collections.abc import Callable
from typing import TypeVar

import scipy

from bouncing_ball_beyond.inherited.contacts.contact.contact import LOSSY, Contact
from bouncing_ball_beyond.inherited.contacts.contact.drop_test import fitted_damping_ratio
from bouncing_ball_beyond.inherited.contacts.contact.quantities import given, single
from bouncing_ball_beyond.inherited.contacts.contact.rebounds import compression
from bouncing_ball_beyond.inherited.contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_beyond.inherited.errors import ParameterError
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper

# Largest number of times that the damping of a drop test is fitted to a stiffness.
_REFITS = 12
_Found = TypeVar("_Found")


def loss(
    contact: Contact,
    omega_of: Callable[[float], float] | None = None,
    gravity: float = STANDARD_GRAVITY,
) -> float:
    """Damping ratio ζ of a contact whose loss is given.

    A drop test needs ``omega_of``, √(k/m) in rad/s as a function of ζ, for the effect of gravity;
    without it gravity is neglected. A damping c needs it, too.

    Raises
    ------
    ModelError
        If no parameter or more than one gives the loss, if the loss is given as a damping c without
        the stiffness, or if r or ζ is out of range.

    Examples
    --------
    >>> loss(Contact(drop_height=4.0, rebound_height=4.0))
    0.0
    """
    release = contact.rule
    others = ", ".join(f"{{{name}}}" for name in LOSSY[:-1])
    ways = f"one of {others}, or {{drop_height}} and {{rebound_height}}"
    name = single(given(contact), LOSSY, "the loss of the contact", ways)
    if name == "damping":
        if contact.stiffness is None or omega_of is None:
            raise ParameterError(
                "{damping} needs {stiffness}: give it, or {restitution} in place of {damping}"
            )
        zeta = contact.damping / (2 * contact.mass * omega_of(0.0))
        return _oscillating(zeta, release, "damping ratio ζ of the contact")
    if name == "damping_ratio":
        return _oscillating(contact.damping_ratio, release, "{damping_ratio}")
    if name == "restitution":
        # A damper that acts on approach only lets go at the table's level too, with another r.
        at_surface = release if release is Release.APPROACH else Release.DISPLACEMENT
        return float(damping_ratio(contact.restitution, at_surface))
    if name == "measured_restitution":
        return float(damping_ratio(contact.measured_restitution, release))
    height = contact.rebound_height
    drop = contact.drop_height
    if height > drop:
        raise ParameterError(f"{{rebound_height}} {height:g} m is above {{drop_height}} {drop:g} m")
    if omega_of is not None:
        return fitted_damping_ratio(omega_of, drop, height, gravity, release)
    return float(damping_ratio(math.sqrt(height / drop), release))


def _oscillating(zeta: float, release: Release, name: str) -> float:
    """ζ, or an error if a free impact with it does not end: a damper that pulls holds the ball."""
    if release is not Release.DISPLACEMENT:
        return zeta
    if not (zeta < 1 and SpringDamper(1.0, zeta, release).restitution > 0):
        why = "near the critical damping 1 and above it the ball does not bounce"
        raise ParameterError(f"{name} = {zeta:.12g} is too large: {why}")
    return zeta


def of_loss(
    contact: Contact, gravity: float, stiffness: Callable[[float], tuple[float, _Found]]
) -> _Found:
    """The contact whose stiffness is found for its ζ, where ζ in turn may depend on the stiffness.

    By gravity the ζ of a drop test depends on the stiffness, though hardly for a stiff contact, so
    that both are found by turns.

    Parameters
    ----------
    contact : Contact
        With its loss, without a stiffness.
    gravity : float
        g in m/s².
    stiffness : callable
        The ω = √(k/m) in rad/s that is found for a ζ, and the result to return for it.

    Raises
    ------
    ModelError
        See :func:`loss`.
    """
    omega, found = stiffness(loss(contact))
    if contact.rebound_height is None:
        return found
    for _ in range(_REFITS):
        before = omega
        omega, found = stiffness(loss(contact, same_omega(before), gravity))
        if math.isclose(omega, before, rel_tol=1e-12):
            break
    return found


def same_omega(omega: float) -> Callable[[float], float]:
    """√(k/m) in rad/s, as a function of ζ, of contacts of one stiffness: it is constant."""
    return lambda zeta: omega


def omega_of_time(duration: float, release: Release) -> Callable[[float], float]:
    """√(k/m) in rad/s, as a function of ζ, of contacts whose free impacts last so many seconds."""
    return lambda zeta: float(SpringDamper.of_duration(duration, zeta, release).frequency_ratio)


def omega_of_penetration(
    depth: float, speed: float, gravity: float, release: Release
) -> Callable[[float], float]:
    """√(k/m) in rad/s, as a function of ζ, of contacts with a greatest compression in m in an
    impact with a speed in m/s, with gravity.

    Examples
    --------
    An elastic ball sinks in by p where kp² = mv² + 2mgp:

    >>> found = omega_of_penetration(0.01, 1.0, 9.81, Release.FORCE)(0.0)
    >>> abs(found - math.sqrt(1 + 2 * 9.81 * 0.01) / 0.01) < 1e-9
    True
    """
    stiffest = math.sqrt(speed**2 + 2 * gravity * depth) / depth

    def surplus(omega: float, zeta: float) -> float:
        # In units of 1/ω and g/ω² the contact has ϖ = 1.
        unit = gravity / omega**2
        found, _ = compression(SpringDamper(1.0, zeta, release), speed * omega / gravity)
        return found * unit / depth - 1

    def omega_of(zeta: float) -> float:
        if zeta == 0:
            return stiffest
        # A damper takes a part of the depth.
        softest = stiffest / 2
        while surplus(softest, zeta) < 0:
            softest /= 2
        return float(scipy.optimize.brentq(surplus, softest, stiffest, (zeta,), xtol=1e-12))

    return omega_of

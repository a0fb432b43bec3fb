r"""What a contact does in an engine whose time step is given, and how stiff it may be there.

In most simulations the time step Δt is given, and the contact has to suit it. With ``h = ωΔt`` a
free impact is computed by the map of the engine's scheme
(:mod:`bouncing_ball_contacts.engines.scheme`) as it is: beyond the limit of stability a ball is
thrown out of a single step, faster than it came. For a given ζ the duration T of a contact in
units of 1/ω is fixed, so that a contact that needs N steps has ::

    ω = T/(N Δt),   k = m ω²,   c = 2ζmω

With the smallest N for which r is within the error, this is the stiffest contact.

r is a function of the time, within a step, from meeting the wall to the first step in contact. Each
state of the contact is linear in this time, so that r is linear between the times at which the
number of steps in contact changes, where it jumps. :func:`spread` bisects for these times, because
the bounds of r are the limits at the jumps.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
import scipy

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release, restitution_coefficient
from bouncing_ball_contacts.engines.impacts import (
    FEWEST,
    bisected,
    fewest_steps,
    has_stable_steps,
    impacts_in_steps,
)
from bouncing_ball_contacts.engines.physical import Physical, free_duration
from bouncing_ball_contacts.engines.scheme import Scheme

# Velocities below this part of that of the impact are those of a ball that does not leave.
_STAYS = 1e-6
# Samples of the time within a step, each of which is divided where r is not linear. A jump is found
# within the last length, and a bend is not seen where it is smaller than the last number.
_SAMPLES = 257
_ROUNDS = 48
_MOST_PARTS = 4096
_STRAIGHT = 1e-10
# How closely the number of steps of the stiffest contact, and ζ of a retuned one, are found.
_FINE = 1e-9
# The sampled error of a number of steps is smaller than the exact one by less than this part.
_MARGIN = 0.1
_TRIED = 81
_ASIDE = 1e-6
# Digits of ζ that decide about this number: the ζ of parameters with twelve digits is the same.
_DIGITS = 10
# Time steps in a contact of a simulation, with a wide margin.
_FEWEST = 1e-3
_MOST = 1e8


@dataclass(frozen=True)
class AtStep:
    """A contact in an engine with a given time step, in SI units.

    ``restitution`` is the r of the contact with small steps. In the engine a free impact has an r
    between ``least`` and ``most``, which depends on where in a step the contact begins, and
    ``error`` is the largest difference from ``restitution``; ``is_within`` tells whether it is
    ``allowed``. ``mean`` is the mean r over all these instants. A ball that does not leave has r =
    0. The contact takes so many ``steps``; it is unstable if the steps of a lasting contact grow.
    With the damping ``retuned`` in N s/m and the same stiffness the mean is ``restitution``. It is
    sought for parameters that are given; it is None if no damping achieves that, or if the contact
    is within the error as it is. ``remarks``
    are sentences on how the engine changes the contact at this step, and ``is_of_parameters`` tells
    whether parameters that contain the step were given. If r depends on the impact ``speed`` in
    m/s, all this holds at this speed, and the damping is that of Hunt and Crossley in s/m.
    """

    engine: str
    time_step: float
    steps: float
    is_stable: bool
    restitution: float
    least: float
    most: float
    error: float
    allowed: float
    is_within: bool
    mean: float = math.nan
    retuned: float | None = None
    remarks: tuple[str, ...] = ()
    is_of_parameters: bool = False
    speed: float | None = None

    @classmethod
    def of(
        cls,
        engine: str,
        time_step: float,
        steps: float,
        restitution: float,
        found: "Spread",
        allowed: float,
        *,
        is_stable: bool = True,
    ) -> "AtStep":
        """What impacts in these steps do to a contact with an r, without a contact that is better
        suited to them.
        """
        error = found.error(restitution)
        return cls(
            engine=engine,
            time_step=time_step,
            steps=steps,
            is_stable=is_stable,
            restitution=restitution,
            least=found.least,
            most=found.most,
            mean=found.mean,
            error=error,
            allowed=allowed,
            is_within=is_stable and error <= allowed,
        )

    @property
    def unit_of_damping(self) -> str:
        """The unit of the damping ``retuned``."""
        return "N s/m" if self.speed is None else "s/m"

    @property
    def span(self) -> str:
        """The r at this step: from the least to the greatest, or one number if they are alike."""
        least = f"{self.least:.4g}"
        most = f"{self.most:.4g}"
        return least if least == most else f"{least} to {most}"

    @property
    def verdict(self) -> str:
        """What the contact does at this step, in one sentence."""
        at = "" if self.speed is None else f" at {self.speed:.4g} m/s"
        found = f"a free impact{at} has r = {self.span} in place of {self.restitution:.4g}"
        if not self.is_stable:
            return f"unstable in {self.engine}: {found}"
        held = "resolved" if self.is_within else "not resolved"
        allowed = "within" if self.is_within else "not within"
        return f"{held} in {self.engine}: {found}, {allowed} {self.allowed:g}"


class Spread(NamedTuple):
    """The least and the greatest r over all instants of contact within a step, and the mean."""

    least: float
    most: float
    mean: float

    def error(self, restitution: float) -> float:
        """The largest difference from an r."""
        return max(self.most - restitution, restitution - self.least)


def spread(impacts: Callable[[np.ndarray], np.ndarray], straight: float = _STRAIGHT) -> Spread:
    """The range and the mean of r, a function of the instant in (0, 1] that is linear in pieces, or
    smooth in pieces if these are divided until they are as ``straight`` as that.

    Examples
    --------
    >>> spread(lambda f: np.where(f < 1 / 3, f, f - 1))
    Spread(least=-0.66666666..., most=0.33333333..., mean=-0.16666666...)
    """
    place = np.linspace(1e-9, 1.0, _SAMPLES)
    value = impacts(place)
    found = [np.stack([place, value])]
    low = found[0][:, :-1]
    high = found[0][:, 1:]
    for _ in range(_ROUNDS):
        middle = (low[0] + high[0]) / 2
        between = np.stack([middle, impacts(middle)])
        found.append(between)
        size = straight * np.maximum(1.0, np.abs(between[1]))
        bent = np.abs(between[1] - (low[1] + high[1]) / 2) > size
        if not 0 < np.count_nonzero(bent) < _MOST_PARTS:
            break
        low = np.concatenate([low[:, bent], between[:, bent]], axis=1)
        high = np.concatenate([between[:, bent], high[:, bent]], axis=1)
    place, value = np.concatenate(found, axis=1)
    order = np.argsort(place, kind="stable")
    mean = np.trapezoid(value[order], place[order]) / np.ptp(place)
    return Spread(float(value.min()), float(value.max()), float(mean))


def spread_in_steps(scheme: Scheme, zeta: float, release: Release, step: float) -> Spread:
    """The range and the mean of r of free impacts with a step h = ωΔt; 0 for balls that stay."""

    def impacts(fraction: np.ndarray) -> np.ndarray:
        found = impacts_in_steps(scheme, zeta, release, step, fraction)
        return np.where(found < _STAYS, 0.0, found)

    return spread(impacts)


def retuned(
    scheme: Scheme, zeta: float, release: Release, step: float, restitution: float
) -> float | None:
    """ζ with which the mean r is the one asked for at a step h = ωΔt; None if there is none.

    Examples
    --------
    Implicit steps damp, so that less damping gives the r asked for, or none gives it:

    >>> zeta = retuned(Scheme.IMPLICIT, 0.1, Release.FORCE, 0.05, 0.7439)
    >>> 0 < zeta < 0.1, retuned(Scheme.IMPLICIT, 0.1, Release.FORCE, 0.8, 0.7439)
    (True, None)
    """

    def surplus(ratio: float) -> float:
        return spread_in_steps(scheme, ratio, release, step).mean - restitution

    most = min(2 * zeta + 0.5, 1 - 1e-6 if release is Release.DISPLACEMENT else math.inf)
    stable = [ratio for ratio in np.linspace(0.0, most, 9) if has_stable_steps(scheme, ratio, step)]
    over = [surplus(ratio) for ratio in stable]
    for k in range(len(stable) - 1):
        if over[k] >= 0 > over[k + 1]:
            return float(
                scipy.optimize.brentq(surplus, stable[k], stable[k + 1], xtol=_FINE, rtol=_FINE)
            )
    return None


@cache
def _fewest(scheme: Scheme, zeta: float, release: Release, error: float) -> float:
    """The number of steps in a contact from which on every r is within an error; infinite if
    rounding keeps r from it.

    The error as a function of this number has bends and jumps. Just below the number returned the
    contact is not within the error. With more steps it is, but for the displacement release, whose
    error has a tooth in each step: of 84 cases single teeth above exceeded the error in ten, by a
    sixth at most.
    """
    duration = free_duration(zeta, release)
    exact = float(restitution_coefficient(zeta, release))

    def sides(steps: float) -> Iterator[float]:
        """The errors at this number of steps and just above it.

        At a whole number of steps r may jump, and parameters are written with twelve digits.
        """
        for side in (steps, steps * (1 + _ASIDE)):
            yield spread_in_steps(scheme, zeta, release, duration / side).error(exact)

    def is_within(steps: float) -> bool:
        return not any(found > error for found in sides(steps))

    sampled = fewest_steps(scheme, zeta, release, error)
    good = sampled * (1 + _MARGIN)
    while (found := max(sides(good))) > error:
        # The error falls about as 1/N.
        good *= max(1 + _MARGIN / 4, found / error)
        if good > _MOST:
            return math.inf
    least = max(FEWEST, sampled * (1 - _MARGIN))
    bad = None
    for steps in np.linspace(good, least, _TRIED)[1:].tolist():
        if not is_within(steps):
            bad = steps
            break
        good = steps
    if bad is None:
        return good
    return bisected(is_within, good, bad, _FINE * good) * (1 + _ASIDE)


def stiffest_contact(
    scheme: Scheme, mass: float, zeta: float, release: Release, time_step: float, error: float
) -> tuple[Physical, float]:
    """The stiffest contact with this ζ whose r is within an error, and its number of time steps.

    Examples
    --------
    >>> ball, steps = stiffest_contact(Scheme.IMPLICIT, 1.0, 0.0, Release.FORCE, 1e-3, 0.1)
    >>> f"{ball.stiffness:.5g} N/m", abs(ball.contact_time(Release.FORCE) / 1e-3 - steps) < 1e-9
    ('4550.6 N/m', True)
    """
    fewest = _fewest(scheme, round(zeta, _DIGITS), release, error)
    omega = free_duration(zeta, release) / (fewest * time_step)
    return Physical(mass, mass * omega**2, 2 * zeta * mass * omega), fewest


def at_step(
    engine: str,
    scheme: Scheme,
    contact: Physical,
    release: Release,
    time_step: float,
    error: float,
    asked: Physical | None = None,
) -> AtStep:
    """What a contact does in an engine's scheme with a time step in s.

    Parameters
    ----------
    engine : str
        Its name, for the texts.
    scheme : Scheme
    contact : Physical
    release : Release
    time_step : float
        Δt in s.
    error : float
        Largest error of r that is allowed, above 0.
    asked : Physical, optional
        The contact that was asked for, if the engine changes it at this step.

    Raises
    ------
    ModelError
        If ζ ≥ 1 with the displacement release, or if contact and step differ by so much that no
        simulation has both.

    Examples
    --------
    >>> ball = Physical(mass=1.0, stiffness=1e8, damping=2e3)
    >>> found = at_step("mujoco", Scheme.SEMI_IMPLICIT, ball, Release.FORCE, 2e-3, 0.001)
    >>> found.is_stable, found.is_within
    (False, False)
    """
    wanted = asked or contact
    r = wanted.restitution(release)
    # The step may have changed the contact.
    for duration in (wanted.contact_time(release), contact.contact_time(release)):
        if not _FEWEST <= duration / time_step <= _MOST:
            raise ModelError(
                f"a contact of {duration:.3g} s takes {duration / time_step:.3g} time steps of "
                f"{time_step:.3g} s, which is not between {_FEWEST:g} and {_MOST:g}: check the "
                "units"
            )
    step = contact.angular_frequency * time_step
    zeta = contact.damping_ratio
    return AtStep.of(
        engine,
        time_step,
        wanted.contact_time(release) / time_step,
        r,
        spread_in_steps(scheme, zeta, release, step),
        error,
        is_stable=has_stable_steps(scheme, zeta, step),
    )


def retuned_damping(
    at: AtStep, scheme: Scheme, contact: Physical, release: Release
) -> float | None:
    """The damping in N s/m with which the mean r of a contact is the one that was asked for; None
    if there is none. For a compensated scheme the contact is that before it compensates the step.
    """
    omega = contact.angular_frequency
    step = omega * at.time_step
    zeta = retuned(scheme, contact.damping_ratio, release, step, at.restitution)
    return None if zeta is None else 2 * zeta * contact.mass * omega

r"""Spring-damper contact: the exact flow in relative coordinates (Eqs. 10-13).

With δ = z - w, the ball in contact obeys ::

    δ″ + 2ζϖ δ′ + ϖ² δ = -1 + Λ sin(s + φ)

where s is the time since the contact started and φ the phase of the table at
that moment. The paper writes the solution with constants A and B, which are determined
by the start of contact. Here they are eliminated: the flow is affine in
(δ₀, δ′₀, Λ cos φ, Λ sin φ), and regular at the resonance ζ = 0, ϖ = 1::

    δ(s) = δ₀ (g′ + 2ζϖ g) + δ′₀ g - G + Λ cos φ · P + Λ sin φ · Q

with g the impulse response, G the response to a constant force and Q + iP
that to e^{is}, all from :mod:`bouncing_ball.models.oscillator`.

All quantities are dimensionless: time Ωt, length Ω²y/g.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.models.contact import Span
from bouncing_ball.models.damping import (
    Release,
    check_damping,
    check_positive,
    damping_ratio,
    restitution_coefficient,
)
from bouncing_ball.models.oscillator import responses
from bouncing_ball.numerics.arrays import Batch

ARGUMENTS = ("time", "displacement", "velocity", "phase", "amplitude")
"""Order of the last axis of :attr:`ContactFlow.jacobian`."""


class ContactFlow(NamedTuple):
    """δ, δ′ and δ″ after a time in contact, arrays of one shape, and the exact Jacobian.

    ``jacobian`` has shape (..., 2, 5): its rows are the derivatives of δ and δ′, its columns are
    in the order of :data:`ARGUMENTS`.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    jacobian: np.ndarray


@dataclass(frozen=True, repr=False)
class SpringDamper(Batch):
    """The paper's contact: ϖ, ζ and the rule that ends it, with f = ϖ² p + 2ζϖ p′ (Eq. 11).

    Its motion has a closed form, see :meth:`flow`.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ ≥ 0, dimensionless.
    release : Release or str
        The condition that ends the contact; the paper's is the default.

    Raises
    ------
    ModelError
        If ϖ or ζ is no number in its range, their shapes do not broadcast, or the release is
        unknown.

    Examples
    --------
    >>> contact = SpringDamper.from_restitution(1.0, [5.0, 10.0], "force")
    >>> contact[1].release, float(contact[1].frequency_ratio)
    (<Release.FORCE: 'force'>, 10.0)
    """

    frequency_ratio: float | np.ndarray
    damping_ratio: float | np.ndarray
    release: Release = Release.DISPLACEMENT

    def __post_init__(self):
        check_positive(self.frequency_ratio, "frequency ratio ϖ")
        check_damping(self.damping_ratio, "damping ratio ζ")
        self.check_shape()
        # Contacts are keys of caches, so that a single number must not be an array.
        for name in ("frequency_ratio", "damping_ratio"):
            value = np.asarray(getattr(self, name))
            object.__setattr__(self, name, value if value.ndim else value.item())
        object.__setattr__(self, "release", Release.of(self.release))

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """The force over the weight, ϖ² p + 2ζϖ p′."""
        omega = self.frequency_ratio
        return omega * (omega * penetration + 2 * self.damping_ratio * rate)

    @classmethod
    def from_restitution(
        cls,
        restitution: ArrayLike,
        frequency_ratio: ArrayLike,
        release: str = Release.DISPLACEMENT,
        *,
        measured: bool = False,
    ) -> SpringDamper:
        """The contact whose damping follows from a restitution coefficient r.

        Parameters
        ----------
        restitution, frequency_ratio : array_like
            r in (0, 1] and ϖ.
        release : Release or str
            The condition that ends the contact.
        measured : bool
            Whether r is the restitution coefficient of a free impact with this release.
            Otherwise r is that of the displacement release (Eq. 16).

        Raises
        ------
        ModelError
            If r or ϖ is outside its range, or the release is unknown.

        Examples
        --------
        >>> float(SpringDamper.from_restitution(1.0, 10.0).damping_ratio)
        0.0
        """
        rule = Release.of(release)
        zeta = damping_ratio(restitution, rule if measured else Release.DISPLACEMENT)
        return cls(check_positive(frequency_ratio, "frequency ratio ϖ"), zeta, rule)

    def implied(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """ζ of a given r, or r of a given ζ (Eq. 16); nothing if neither is given.

        Examples
        --------
        >>> contact = SpringDamper(2.0, 0.1)
        >>> float(contact.implied({"restitution": 1.0})["damping_ratio"])
        0.0
        """
        if "restitution" in values:
            return {"damping_ratio": damping_ratio(values["restitution"])}
        if "damping_ratio" in values:
            zeta = values["damping_ratio"]
            return {"restitution": restitution_coefficient(zeta, Release.DISPLACEMENT)}
        return {}

    @cached_property
    def release_sine(self) -> np.ndarray:
        """sin α = κϖ/2: 0 for the displacement release, ζ for the force release."""
        return self.release.sine(self.damping_ratio)

    @cached_property
    def lag(self) -> np.ndarray:
        """κ: the contact ends where δ + κ δ′ = 0."""
        return 2 * self.release_sine / self.frequency_ratio

    @property
    def restitution(self) -> np.ndarray:
        """Restitution coefficient of a free impact with this release.

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        return restitution_coefficient(self.damping_ratio, self.release)

    @property
    def free_angle(self) -> np.ndarray:
        """π - 2α: the angle ϖ_d s at which a free contact, without load, ends.

        Raises
        ------
        ModelError
            If ζ ≥ 1: an overdamped contact does not oscillate.
        """
        self._require_underdamped()
        return self.release.free_angle(self.damping_ratio)

    @cached_property
    def damped_frequency(self) -> np.ndarray:
        """ϖ_d = ϖ√(1 - ζ²).

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        self._require_underdamped()
        return self.frequency_ratio * np.sqrt((1 - self.damping_ratio) * (1 + self.damping_ratio))

    @property
    def free_duration(self) -> np.ndarray:
        """Duration (π - 2α)/ϖ_d of the free contact.

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        return self.free_angle / self.damped_frequency

    def _require_underdamped(self) -> None:
        zeta = np.asarray(self.damping_ratio, dtype=float)
        require(zeta < 1, zeta, "damping ratio ζ", "below 1: the contact does not oscillate")

    def flow(
        self,
        time: ArrayLike,
        displacement: ArrayLike,
        velocity: ArrayLike,
        phase: ArrayLike,
        amplitude: ArrayLike,
    ) -> ContactFlow:
        """The relative state of the ball a time s after (δ₀, δ′₀), in contact (Eqs. 12-13).

        Parameters
        ----------
        time, displacement, velocity, phase, amplitude : array_like
            s, δ₀, δ′₀, the table's phase φ at the start, and Λ.

        Returns
        -------
        ContactFlow
            Its fields have the shape to which the arguments and the contact broadcast.

        Examples
        --------
        On a table at rest and without damping, gravity and spring balance at δ = -1/ϖ²:

        >>> flow = SpringDamper(2.0, 0.0).flow(3.0, -0.25, 0.0, 0.0, 0.0)
        >>> round(float(flow.displacement), 14), abs(round(float(flow.velocity), 14))
        (-0.25, 0.0)
        """
        state = time, displacement, velocity, phase, amplitude
        columns = (*state, self.frequency_ratio, self.damping_ratio)
        rows = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in columns))
        s, d0, v0, phi, lam, omega, zeta = rows
        loss = 2 * zeta * omega
        stiffness = omega * omega
        g, G, h = responses(s, omega, zeta)
        turn = np.exp(1j * phi)
        drive = lam * turn
        # The free response to a unit displacement.
        free = g.rate + loss * g.value
        d = d0 * free + v0 * g.value - G.value + np.imag(drive * h.value)
        v = v0 * g.rate - d0 * stiffness * g.value - G.rate + np.imag(drive * h.rate)
        acc = lam * np.sin(s + phi) - 1 - loss * v - stiffness * d
        of_displacement = (v, free, g.value, np.real(drive * h.value), np.imag(turn * h.value))
        of_velocity = (
            acc,
            -stiffness * g.value,
            g.rate,
            np.real(drive * h.rate),
            np.imag(turn * h.rate),
        )
        jacobian = np.moveaxis(np.array([of_displacement, of_velocity]), (0, 1), (-2, -1))
        return ContactFlow(d, v, acc, jacobian)

    def during(self, span: Span, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ s ≤ D after the starts of contacts, one time for each contact."""
        start = span.displacement, span.velocity, span.phase
        flow = self.flow(time, *start, span.amplitude)
        return flow.displacement, flow.velocity

"""Contacts that the inherited :mod:`bouncing_ball_beyond.inherited.models.damping` lacks:
overdamped ones, and a damper that acts on approach only.

An overdamped ball does not come back to the table's level, but its force vanishes. A damper that
acts on approach only is a linear contact up to the greatest penetration, at the angle arccos ζ, and
then the spring alone, for a quarter of its period. The first part multiplies the speed ω p by
``exp(-ζ arccos ζ / √(1 - ζ²))``, which is the root of the r of the force release, because
π - 2 arcsin ζ = 2 arccos ζ; the second part conserves it.
"""

from collections.abc import Callable
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import one_of, require
from bouncing_ball_beyond.inherited.models import damping as linear
from bouncing_ball_beyond.inherited.models.damping import check_restitution, damped_frequency
from bouncing_ball_beyond.inherited.numerics.arrays import as_numbers
from bouncing_ball_beyond.inherited.numerics.elementary import logarithm


class Release(StrEnum):
    """The condition that ends a contact: those of the inherited library, and one more."""

    DISPLACEMENT = linear.Release.DISPLACEMENT
    FORCE = linear.Release.FORCE
    APPROACH = "approach"
    """The damper acts while the ball approaches only: the force vanishes where δ = 0."""

    @classmethod
    def of(cls, rule: str) -> "Release":
        """The release with this name; a :exc:`.ModelError` if there is none."""
        return one_of("release", rule, {str(each): each for each in cls})

    @property
    def at_surface(self) -> bool:
        """Whether the contact ends at the table's level, κ = 0."""
        return self is not Release.FORCE

    @property
    def is_linear(self) -> bool:
        """Whether the contact is linear from its start to its end."""
        return self is not Release.APPROACH

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Callable[[Any], Any]) -> Any:
        # A parameter of a study is the release of a linear contact, of which it has closed forms.
        schema = handler(source)
        members = [rule for rule in schema["members"] if rule.is_linear]
        check = {"type": "no-info", "function": cls._linear}
        return {
            "type": "function-after",
            "schema": schema | {"members": members},
            "function": check,
        }

    @staticmethod
    def _linear(rule: "Release") -> "Release":
        if not rule.is_linear:
            raise ValueError(f"must be one of {', '.join(LINEAR)}")
        return rule

    def sine(self, damping_ratio: ArrayLike) -> np.ndarray:
        """``sin α = κϖ/2``: ζ for the force release, 0 at the table's level."""
        return linear.Release(self if self.is_linear else "displacement").sine(damping_ratio)

    def damped_angle(self, damping_ratio: ArrayLike) -> np.ndarray:
        """The angle ϖ_d s during which the damper of a free contact with ζ < 1 acts.

        It is π - 2α, and arccos ζ for a damper that acts on approach only.

        Examples
        --------
        >>> angles = [float(rule.damped_angle(0.5)) for rule in Release]
        >>> [round(angle / np.pi, 12) for angle in angles]
        [1.0, 0.666666666667, 0.333333333333]
        """
        if self.is_linear:
            return linear.Release(self).free_angle(damping_ratio)
        return linear.Release.FORCE.free_angle(damping_ratio) / 2

    def free_angle(self, damping_ratio: ArrayLike) -> np.ndarray:
        """The angle ϖ_d s at which a free contact with ζ < 1 ends.

        It is π - 2α. After a damped approach the spring alone takes a quarter of its period, to
        the angle arccos ζ + (π/2)√(1 - ζ²).

        Examples
        --------
        >>> float(Release.DISPLACEMENT.free_angle(0.5)) == np.pi
        True
        """
        damped = self.damped_angle(damping_ratio)
        if self.is_linear:
            return damped
        zeta = np.asarray(damping_ratio, dtype=float)
        return damped + np.pi / 2 * damped_frequency(zeta)

    def require_rebound(self, damping_ratio: ArrayLike) -> np.ndarray:
        """ζ as an array.

        Raises
        ------
        ModelError
            If any ζ is no number or negative, or not below 1 for the displacement release, under
            which an overdamped ball does not come back to the table's level.
        """
        allowed = "a number ≥ 0"
        if self is Release.DISPLACEMENT:
            allowed = "in [0, 1): an overdamped contact has no restitution coefficient"
        zeta = as_numbers(damping_ratio, "damping ratio ζ", allowed)
        below = 1.0 if self is Release.DISPLACEMENT else np.inf
        require((zeta >= 0) & (zeta < below), zeta, "damping ratio ζ", allowed)
        return zeta

    def overdamped_duration(self, damping_ratio: ArrayLike) -> np.ndarray:
        """The time, in units of 1/ω, during which the damper of a free contact with ζ ≥ 1 acts.

        With ζ = cosh β it is 2β/sinh β for the force release, which is 2 at ζ = 1, and half of that
        for a damper that acts on approach only.

        Examples
        --------
        >>> float(Release.FORCE.overdamped_duration(1.0))
        2.0
        """
        zeta = np.asarray(damping_ratio, dtype=float)
        sinh = np.sqrt((zeta - 1) * (zeta + 1))
        half = np.where(sinh > 0, np.arcsinh(sinh) / np.where(sinh > 0, sinh, 1.0), 1.0)
        return 2 * half if self.is_linear else half


LINEAR = tuple(rule for rule in Release if rule.is_linear)
"""The release rules of contacts that are linear from their start to their end."""


def check_damping(value: ArrayLike, name: str) -> np.ndarray:
    """A parameter as an array.

    Raises
    ------
    ModelError
        Unless all its entries are finite numbers and not negative.

    Examples
    --------
    >>> float(check_damping(0.0, "damping C"))
    0.0
    """
    allowed = "a finite number ≥ 0"
    x = as_numbers(value, name, allowed)
    require(np.isfinite(x) & (x >= 0), x, name, allowed)
    return x


def damping_ratio(restitution: ArrayLike, release: str = Release.DISPLACEMENT) -> np.ndarray:
    """Damping ratio ζ of a free contact with the restitution coefficient r.

    It is that of :func:`bouncing_ball_beyond.inherited.models.damping.damping_ratio`; for a damper
    that acts on approach only ζ = cos β with ``β cot β = -ln r``, that of the force release with
    r².

    Parameters
    ----------
    restitution : array_like
        As in the root; in (e⁻¹, 1] for a damper that acts on approach only.
    release : Release or str
        The condition that ends the contact in which r is measured.

    Raises
    ------
    ModelError
        If any r lies outside its range, or the release is unknown.

    Examples
    --------
    >>> round(float(damping_ratio(0.8, "approach") / damping_ratio(0.8**2, "force")), 14)
    1.0
    """
    rule = Release.of(release)
    if rule.is_linear:
        return linear.damping_ratio(restitution, rule)
    r = check_restitution(restitution)
    decrement = np.abs(logarithm(r))
    allowed = f"in (e⁻¹, 1], the range of the {rule} release with ζ < 1"
    require(decrement < 1, r, "restitution coefficient r", allowed)
    return linear.force_damping_ratio(2 * decrement)


def restitution_coefficient(damping: ArrayLike, release: str = Release.DISPLACEMENT) -> np.ndarray:
    """Restitution coefficient of a free contact with a spring and a damper.

    For ζ < 1 it is that of
    :func:`bouncing_ball_beyond.inherited.models.damping.restitution_coefficient`. An overdamped
    contact, whose ζ = cosh β, has ``r = exp(-2ζβ/sinh β)`` with the force release. If the damper
    acts on approach only, r is the root of that of the force release.

    Parameters
    ----------
    damping : array_like
        ζ in [0, 1) for the displacement release, and at least 0 for the others.
    release : Release or str
        The condition that ends the contact.

    Raises
    ------
    ModelError
        If any ζ lies outside this range.

    Examples
    --------
    >>> [round(float(restitution_coefficient(z, "approach")), 4) for z in (0.1, 0.2, 0.3)]
    [0.8626, 0.7561, 0.6715]
    >>> bool(restitution_coefficient(1.0, "force") == np.exp(-2))
    True
    """
    rule = Release.of(release)
    zeta = rule.require_rebound(damping)
    over = zeta >= 1
    under = np.where(over, 0.0, zeta)
    if rule.is_linear:
        found = linear.restitution_coefficient(under, rule)
    else:
        found = np.sqrt(linear.restitution_coefficient(under, linear.Release.FORCE))
    if not over.any():
        return found
    large = np.where(over, zeta, 1.0)
    return np.where(over, np.exp(-large * rule.overdamped_duration(large)), found)[()]

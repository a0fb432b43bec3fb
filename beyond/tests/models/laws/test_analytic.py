"""A force whose imaginary steps are wrong is refused when a ball on it is made."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.restitution_by_speed import RestitutionLaw, RestitutionLawModel


@dataclass(frozen=True, repr=False)
class Quadratic(ContactLaw):
    """A spring with a damper whose force grows as the square of the speed."""

    stiffness: float
    damping: float

    name: ClassVar[str] = "quadratic"
    root: ClassVar[int] = 1
    release = Release.DISPLACEMENT

    def size(self, rate):
        return np.sqrt(rate * rate)

    def force(self, penetration, rate):
        return self.stiffness * penetration + self.damping * rate * self.size(rate)


class WithAbs(Quadratic):
    """The same force, written with a function that is not analytic."""

    name: ClassVar[str] = "with-abs"

    def size(self, rate):
        return np.abs(rate)


class WithBranches(Quadratic):
    """The same force, in two branches."""

    name: ClassVar[str] = "with-branches"

    def size(self, rate):
        return np.where(rate > 0, rate, -rate)


class WithHypot(Quadratic):
    """A force that refuses complex numbers."""

    name: ClassVar[str] = "with-hypot"

    def size(self, rate):
        return np.hypot(rate, 1e-3)


def multipliers_by_differences(ball, amplitude):
    """The multipliers of the 1-T orbit from balls that start beside it."""
    one = bouncing_ball_beyond.orbit(ball, amplitude=amplitude)
    h = 1e-5

    def after(phase, velocity):
        found = ball.cycle(amplitude, phase, velocity)
        return np.array([phase + found.time - 2 * np.pi, found.relative_velocity])

    start = one.phase, one.relative_impact_velocity
    by_phase = (after(start[0] + h, start[1]) - after(start[0] - h, start[1])) / (2 * h)
    by_velocity = (after(start[0], start[1] + h) - after(start[0], start[1] - h)) / (2 * h)
    matrix = np.stack([by_phase, by_velocity], axis=1)
    return one, np.sort_complex(np.linalg.eigvals(matrix).astype(complex))


def test_a_force_with_abs_is_refused_and_its_analytic_forms_are_right():
    with pytest.raises(ModelError, match="with-abs is not analytic in p′: at p′ = ") as caught:
        bouncing_ball_beyond.contact_law(WithAbs(400.0, 0.5))
    assert "\n" not in str(caught.value) and "np.sqrt(x * x)" in str(caught.value)
    with pytest.raises(ModelError, match="refuses complex numbers"):
        bouncing_ball_beyond.contact_law(WithHypot(400.0, 0.5))
    for law in (Quadratic(400.0, 0.5), WithBranches(400.0, 0.5)):
        one, expected = multipliers_by_differences(bouncing_ball_beyond.contact_law(law), 1.6)
        found = np.sort_complex(one.multipliers())
        # The difference has an error of 1e-11/h and of h².
        assert np.abs(found - expected).max() < 1e-5


@dataclass(frozen=True, repr=False)
class Slower(RestitutionLaw):
    """r falls with the speed, written with a function that is not analytic."""

    scale: float

    def restitution(self, speed):
        return 1 / (1 + np.abs(speed) / self.scale)


def test_a_restitution_with_abs_is_refused():
    with pytest.raises(ModelError, match=r"r\(v\) of Slower is not analytic in v"):
        RestitutionLawModel(Slower(2.0))

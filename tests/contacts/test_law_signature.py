"""The signature of a law, against the closed form and against what it stands for."""

import numpy as np
import pytest

from bouncing_ball.contacts.collocation import contacts, path
from bouncing_ball.contacts.law_signature import LawSignature, free_impact
from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
from bouncing_ball.contacts.laws.kuwabara_kono import KuwabaraKono
from bouncing_ball.contacts.laws.linear import Linear
from bouncing_ball.contacts.laws.tsuji import Tsuji
from bouncing_ball.contacts.quadrature import share, share_rate
from bouncing_ball.contacts.signature import LinearSignature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError

LAWS = {
    "linear, force release": Linear(10.0, 0.136, "force"),
    "hunt-crossley": HuntCrossley(1e3, 0.08),
    "tsuji": Tsuji(1e3, 0.3),
    "kuwabara-kono": KuwabaraKono(1e3, 0.005),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_the_linear_law_has_the_closed_form(release):
    exact = LinearSignature(SpringDamper(20.0, 0.13, release))(1.0)
    computed = LawSignature(Linear(20.0, 0.13, release))([0.1, 3.3])
    for name in ("delay", "restitution", "load", "duration"):
        np.testing.assert_allclose(getattr(computed, name), getattr(exact, name), rtol=1e-12)
    # In parts of the quantity over v: the digits of a Chebyshev derivative.
    for name in ("d_delay", "d_restitution", "d_load"):
        np.testing.assert_allclose(getattr(computed, name), 0.0, atol=1e-11)


@every_law
def test_the_delay_is_the_centroid_of_the_force(law):
    v = 3.0
    end, instant = contacts(law, v, weight=0.0), free_impact(law, v)
    # t = D S(x) as in the collocation: the force is smooth in x.
    x, w = np.polynomial.legendre.leggauss(60)
    x, w = (x + 1) / 2, w / 2
    time = float(end.duration) * share(x, law.root)
    force = law.force(*path(law, end, v, time)) * w * share_rate(x, law.root)
    centroid = np.sum(force * time) / np.sum(force)
    assert centroid == pytest.approx(float(instant.delay), rel=1e-9)


@every_law
def test_the_load_sensitivity_is_that_of_the_continued_flights(law):
    # σ by its definition: contacts under small loads ±a, the flights continued to t_c.
    a, v = 1e-3, 3.0
    shifted = []
    for load in (a, -a):
        end = contacts(law, v, weight=load)
        out = -end.rate
        # Both flights are parabolas of the load a; they meet where the distance vanishes.
        # δ_in = -v t - a t²/2, δ_out = δ_b + (out)(t - D) - a (t - D)²/2.
        gap_rate = out + load * end.duration + v
        gap = -end.penetration - out * end.duration - load * end.duration**2 / 2
        meet = -gap / gap_rate
        speed_in = v + load * meet
        speed_out = out + load * (end.duration - meet)
        r = free_impact(law, speed_in).restitution
        shifted.append(speed_out - r * speed_in)
    sigma = (shifted[0] - shifted[1]) / (2 * a)
    # The next order in a/v is a² relative to the first, once differenced.
    assert float(sigma) == pytest.approx(float(free_impact(law, v).load), abs=1e-7)


@every_law
def test_the_table_is_the_impact_itself(law):
    speed = np.array([1e-4, 0.3, 2.0, 7.9, 8.1, 30.0])
    tabulated, itself = LawSignature(law)(speed), free_impact(law, speed)
    for name in ("delay", "restitution", "duration"):
        np.testing.assert_allclose(getattr(tabulated, name), getattr(itself, name), rtol=1e-12)
    np.testing.assert_allclose(tabulated.load / itself.duration, itself.load / itself.duration,
                               atol=1e-12)  # fmt: skip
    np.testing.assert_allclose(
        tabulated.d_restitution * speed, itself.d_restitution * speed, atol=1e-11
    )


def test_a_law_of_power_law_scales():
    # r of Hunt and Crossley depends on C v alone, and D goes as v^{-1/5} at the same C v.
    slow, fast = (free_impact(HuntCrossley(100.0, 0.2 / v), v) for v in (1.0, 32.0))
    assert float(slow.restitution) == pytest.approx(float(fast.restitution), rel=1e-13)
    assert float(slow.duration / fast.duration) == pytest.approx(2.0, rel=1e-12)
    # Kuwabara and Kono's on C K^{2/5} v^{1/5}.
    slow, fast = (free_impact(KuwabaraKono(100.0, 0.02 / v**0.2), v) for v in (1.0, 32.0))
    assert float(slow.restitution) == pytest.approx(float(fast.restitution), rel=1e-13)


def test_what_is_refused():
    with pytest.raises(ModelError, match="one law, not many"):
        LawSignature(HuntCrossley(np.array([1.0, 2.0]), 0.1))
    with pytest.raises(ModelError, match="must let the ball go"):
        LawSignature(HuntCrossley(1.0, 1e9))(1.0)
    for law, bad in ((HuntCrossley, (0.0, 0.1)), (Tsuji, (1.0, 2.3)), (KuwabaraKono, (1.0, -1))):
        with pytest.raises(ModelError, match="is not"):
            law(*bad)

"""Single contacts: exact answers, and starts without a contact. See also the contract of all
laws.
"""

import numpy as np
import pytest
from loaded_laws import Sharing
from scipy.special import beta

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.laws.collocation import contacts, path
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball_beyond.models.laws.hertzian import (
    HuntCrossley,
    KuwabaraKono,
    Tsuji,
    tsuji_damping,
)
from bouncing_ball_beyond.models.laws.law_of_impact import law_of_impact
from bouncing_ball_beyond.models.laws.march import march
from bouncing_ball_beyond.models.laws.panel import BallsInContact, Start
from bouncing_ball_beyond.models.laws.sweeps import Sweeps
from bouncing_ball_beyond.models.spring_damper import SpringDamper


@pytest.mark.parametrize("law", [HuntCrossley(50.0, 0.0), Tsuji(50.0, 0.0), KuwabaraKono(50.0, 0)])
def test_an_elastic_hertz_impact_has_the_duration_and_depth_of_the_closed_form(law):
    # (2/5) K p^{5/2} = v²/2 at the greatest penetration, and D = (4/5) B(2/5, 1/2) p/v.
    v = 2.0
    deepest = (5 * v * v / (4 * 50.0)) ** 0.4
    end = contacts(law, v, weight=0.0)
    assert float(end.duration) == pytest.approx(0.8 * beta(0.4, 0.5) * deepest / v, rel=1e-13)
    assert float(end.rate) == pytest.approx(-v, rel=1e-13)
    # Inside, the path is as exact as its coefficients have fallen.
    depth, _ = path(law, end, end.duration / 2, v, weight=0.0)
    assert float(depth) == pytest.approx(deepest, rel=1e-9)


def test_a_path_within_a_rounding_error_of_its_end_is_a_straight_line():
    # A free ball leaves an undamped spring with the speed of its impact: p = v h.
    law = HuntCrossley(50.0, 0.0)
    end = contacts(law, 2.0, weight=0.0)
    h = 1e-9 * end.duration
    depth, rate = path(law, end, end.duration - h, 2.0, weight=0.0)
    # The end is known to a rounding or two, a millionth of h.
    assert float(depth) == pytest.approx(2 * h, rel=1e-5) and float(rate) == pytest.approx(-2.0)


@pytest.mark.parametrize("restitution", [0.95, 0.65, 0.3, 0.1])
def test_tsujis_damping_gives_its_restitution_at_every_speed(restitution):
    law = Tsuji(300.0, tsuji_damping(restitution))
    speed = np.array([1e-3, 1.0, 50.0])
    end = contacts(law, speed, weight=0.0)
    np.testing.assert_allclose(-end.rate / speed, restitution, rtol=1e-12)


def test_a_shared_load_holds_an_undamped_ball_up_to_the_level():
    # p = b sin ωt + c (1 - cos ωt), b = v/ω, c = (1 - d)/ω²: zero where tan(ωt/2) = -b/c.
    end = contacts(Sharing(3.0, 0.0, 0.5), 2.0)
    np.testing.assert_allclose(end.rate, -2.0, rtol=1e-13)
    assert abs(end.penetration) < 1e-14
    b = 2 / 3
    c = 0.5 / 9
    np.testing.assert_allclose(end.duration, 2 * (np.pi - np.arctan2(b, c)) / 3, rtol=1e-13)
    # With c the derivatives by v and by the weight, in proportion to which c is.
    by = 2 / 3 * c / (b * b + c * c) * np.array([-1 / 3, b])
    np.testing.assert_allclose(end.jacobian[0, [1, 3]], by, rtol=1e-13)


def test_a_release_at_the_surface_has_the_penetration_zero_exactly():
    end = contacts(SpringDamper(10.0, 0.1), np.linspace(1, 5, 999), 0.3, 1.2)
    assert np.isfinite(end.duration).all() and not end.penetration.any()


def test_a_contact_has_as_many_panels_in_all_units():
    # Another stiffness is another unit of time and length, at one speed without a load.
    start = Start(*np.array([0.0, 2.0, 0.0, 0.0, 0.0])[:, np.newaxis])

    def panels(law):
        return next(k for k in range(99) if march(law, start, k).duration > 0)

    for law in (HuntCrossley, Tsuji):
        assert len({panels(law(10.0**k, 0.3)) for k in (-8, 0, 8)}) == 1


def test_a_contact_does_not_depend_on_its_neighbours_in_the_row():
    law = HuntCrossley(np.array([1e2, 1e5, 1e8]), 0.1)
    together = contacts(law, [3.0, np.nan, 2.0], 0.5, 0.9)
    assert np.isnan(together.duration[1])
    for k in (0, 2):
        alone = contacts(law[k], [3.0, 0, 2.0][k], 0.5, 0.9)
        assert float(together.duration[k]) == pytest.approx(float(alone.duration), rel=1e-14)


@pytest.mark.parametrize("until", [None, np.ones(1)], ids=["release", "time"])
@pytest.mark.parametrize(
    "law", [ElastoBacklash(3.0, 0.2), Sharing(3.0, 0.1, 0.9, 0.5, width=0.5), Tsuji(50.0, 0.2)]
)
def test_newtons_slopes_at_the_end_of_a_panel_are_the_derivatives_along_the_motion(law, until):
    start = Start(*np.array([0.0, 2.0, 0.4, 1.2, 1.0])[:, np.newaxis])
    sweeps = Sweeps(law, start, BallsInContact(*np.ones((8, 1))), until)
    m = law.root
    state = np.array([[0.3], [-0.7], [0.2]])
    slope = np.array([[-0.7], [-1.7], [m * 0.3 ** (m - 1)]])
    # dq/ds is p′ and dt/ds is λ, and p″λ is any number. Central differences, 10⁻¹² + ε/10⁻⁶.
    (ahead, _), (back, _), (_, found) = (
        sweeps.left(*(state + h * slope), slope[1]) for h in (1e-6, -1e-6, 0)
    )
    np.testing.assert_allclose(found, (ahead - back) / 2e-6, rtol=1e-8)


def test_contacts_of_a_ball_coming_to_rest_end_despite_rounding():
    # Rounding of the load, 10⁻¹⁶/ϖ², moves the end of so slow a contact by more than the part of
    # its last panel to which the others are computed.
    zero = np.zeros(200)
    one = np.ones(200)
    start = Start(zero, np.geomspace(1e-6, 1e-4, 200), zero + 1.456, one, one)
    assert np.isfinite(march(Sharing(31.4, 0.1335, 0.95), start, 40).duration).all()
    # The load of nearly zero lets go of these after a long contact.
    start = start._replace(rate=np.linspace(8e-4, 9e-4, 200), phase=zero - 0.1135)
    law = Sharing(104.7, 0.0535, 0.95, 0.9, width=0.016)
    assert np.isfinite(march(law, start, 400).duration).all()


def test_a_long_contact_ends_although_its_neighbours_do_not():
    # Panels that end a contact take twice as many sweeps as the others, which are 99 in 100 here.
    zero = np.zeros(300)
    one = np.ones(300)
    law = SpringDamper(20.0, 1.3)
    start = Start(zero, one, zero, np.where(np.arange(300) < 3, 1.36, 0.3), one)
    together = march(law, start, 60).duration
    alone = march(law, Start(*(x[:3] for x in start)), 60).duration
    np.testing.assert_allclose(together, np.append(alone, np.full(297, np.nan)), rtol=1e-14)


def test_a_ball_without_speed_or_put_down_slowly_has_no_end_of_contact():
    # A ball put down slowly on a table at rest stays.
    assert np.isnan(contacts(HuntCrossley(100.0, 0.5), 0.01).duration)
    # No speed, no impact.
    assert np.all(np.isnan(contacts(Tsuji(100.0, 0.5), [0.0, -1.0]).duration))


class _Pulling(ContactLaw):
    name = "pulling"

    def force(self, penetration, rate):
        return -penetration


class _Sinking(ContactLaw):
    """Overdamped: a free ball takes an infinite time to return to the table's level."""

    name = "sinking"

    def force(self, penetration, rate):
        return penetration + 4 * rate


@pytest.mark.parametrize(("zeta", "angle"), [(1.0, 2.0), (1.25, 8 / 3 * np.log(2))])
def test_a_law_without_oscillation_that_shares_the_load_releases_the_ball(zeta, angle):
    # ϖD = 2 arcosh ζ/√(ζ² - 1) and r = exp(-ζϖD), and σ_d as for ζ < 1.
    omega = 50.0
    d = 0.95
    r = np.exp(-zeta * angle)
    impact = Sharing(omega, zeta, d).signature(1.0)
    lag = 2 * zeta / omega
    load = (1 - r) * angle / omega - (2 - d) * lag * r
    expected = [r * (angle / omega + lag) / (1 + r), r, load, angle / omega]
    assert impact[:4] == pytest.approx(expected, rel=1e-12)


def test_a_law_that_sinks_pulls_or_has_no_scales_is_refused():
    with pytest.raises(ModelError, match="sinking: a free impact of speed 2 does not end"):
        _Sinking().signature(2.0)
    with pytest.raises(ModelError, match="pulling does not stop the ball"):
        contacts(_Pulling(), 1.0)
    for r in (0.95, 1.0):
        with pytest.raises(ModelError, match="pulling is given by its parameters, not by rest"):
            law_of_impact(_Pulling, r, 0.3, 1.0)
    for value in (0.0, -1.0, np.inf):
        with pytest.raises(ModelError, match=r"contact duration D = .* is not a finite number > 0"):
            law_of_impact(HuntCrossley, 0.65, value, 3.8)

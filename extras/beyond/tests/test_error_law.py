"""The error law against exact orbits, and error thresholds against the article and another code."""

import numpy as np
import pytest

from bouncing_ball import errors as replication
from bouncing_ball.spring_damper import damping_ratio
from bouncing_ball_beyond.contacts.balls import Corrected, Rigid, SpringDamper
from bouncing_ball_beyond.contacts.named_laws import hunt_crossley, kuwabara_kono, tsuji
from bouncing_ball_beyond.errors.error_law import (
    QUANTITIES,
    FreeImpact,
    ball_at_ratio,
    contact_values,
    error_thresholds,
    exact_errors,
    free_impact,
    law_coefficients,
    law_errors,
    law_thresholds,
    restitution_values,
)
from bouncing_ball_beyond.periodic.orbits import orbit
from bouncing_ball_beyond.tables.table import SINE, Table

ARTICLE = {
    # Quantity: K, and ϖ for 1 % by the law, exactly, and of the corrected model (Table 1).
    "max_height": (-0.821, 82.18, 82.18, 2.29),
    "bounce_velocity": (-0.612, 61.17, 61.22, 1.581),
    "phase": (-0.177, 17.815, 18.054, 2.083),
    "apparent_restitution": (-0.046, 4.608, 4.775, 3.237),
    "saddle_node": (-0.602, 60.16, 59.87, 5.167),
    "period_doubling": (-0.158, 15.84, 13.75, 5.897),
}
BALL = SpringDamper(1.0, restitution=0.65)


def random_orbits(rng, rows, lowest=0.0):
    """r, n and Λ of orbits between the bifurcations of the restitution model."""
    r = rng.uniform(0.2, 0.98, rows)
    line = np.pi * (1 - r) / (1 + r)
    doubling = np.hypot(line, 2 * (1 + r**2) / (1 + r) ** 2)
    return r, line + (doubling - line) * rng.uniform(lowest, 1, rows)


def test_table_of_the_article():
    """Its printed digits: K, and the thresholds of 1 %."""
    law = law_thresholds(BALL, amplitude=1.0)
    coefficients = law_coefficients(BALL, amplitude=1.0)
    exact = error_thresholds(BALL, amplitude=1.0)
    corrected = error_thresholds(BALL, amplitude=1.0, simple=Corrected)
    for name, (coefficient, by_law, ratio, of_corrected) in ARTICLE.items():
        assert coefficients[name] == pytest.approx(coefficient, abs=5.1e-4)
        assert law[name] == pytest.approx(by_law, rel=5e-4)
        assert exact[name].ratio == pytest.approx(ratio, rel=5e-4)
        assert corrected[name].ratio == pytest.approx(of_corrected, rel=5e-4)


@pytest.mark.parametrize(
    ("n", "r", "amplitude", "release"),
    [(1, 0.65, 1.0, "displacement"), (2, 0.4, 2.9, "displacement"), (1, 0.8, 0.7, "force")],
)
def test_thresholds_of_the_replication(n, r, amplitude, release):
    """The root's package is another code for the same orbits, along ϖ by continuation."""
    grid = np.geomspace(3, 1e5, 80)
    zeta = damping_ratio(r, release)
    ball = SpringDamper(1.0, damping_ratio=zeta, release=release)
    assert ball.signature(1.0).restitution == pytest.approx(r, rel=1e-14)
    names = {name: name for name in QUANTITIES} | {"phase": "phase_in_periods"}
    errors = replication.errors([*names.values()], n, r, amplitude, grid, release)
    known = {"amplitude": amplitude, "n": n, "low": 3, "high": 1e5}
    thresholds = error_thresholds(ball, **known)
    for name in QUANTITIES:
        other = replication.threshold(grid, errors[names[name]], 0.01)
        if other.status == "first orbit":
            # The replication leaves out unstable orbits, which are compared here.
            assert not thresholds[name].ratio > other.ratio
            continue
        assert thresholds[name].status == other.status
        # Both root finders stop at rounding, which is 1e-16 of values whose errors are 0.01.
        assert thresholds[name].ratio == pytest.approx(other.ratio, rel=1e-11, nan_ok=True)


def test_remainder_is_of_second_order():
    """From ϖ = 1000 to 2000 what the law leaves falls to a quarter, up to terms of third order."""
    r, amplitude = random_orbits(np.random.default_rng(1), 40, lowest=0.3)
    remainders = []
    for ratio in (1000.0, 2000.0):
        ball = SpringDamper(ratio, restitution=r)
        law = law_errors(ball, amplitude=amplitude)
        exact = exact_errors(ball, amplitude=amplitude)
        remainders.append({name: exact[name] - law[name] for name in QUANTITIES})
    for name in QUANTITIES:
        quotient = np.median(remainders[0][name] / remainders[1][name])
        assert quotient == pytest.approx(4, abs=0.1), name


def test_remainder_at_the_saddle_node_is_of_order_three_halves():
    r = np.linspace(0.3, 0.9, 13)
    impact = free_impact(SpringDamper(1.0, restitution=r))
    line = impact.speed - np.pi
    remainders = []
    for ratio in (1e5, 2e5):
        ball = SpringDamper(ratio, restitution=r)
        law = law_errors(ball, amplitude=line)["max_height"]
        exact = exact_errors(ball, amplitude=line, quantities=["max_height"])["max_height"]
        remainders.append(exact - law)
    quotients = remainders[0] / remainders[1]
    np.testing.assert_allclose(quotients, 2**1.5, rtol=0.02)
    # The error itself is √(2Cs)/H, up to terms that are smaller by √s.
    height = np.sqrt(2 * line * impact.load / (1 + r) / 1e8) / (np.pi**2 / 2)
    error = law_errors(SpringDamper(1e8, restitution=r), amplitude=line)["max_height"]
    np.testing.assert_allclose(error, height, rtol=1e-2)


def test_corrected_model_is_of_second_order():
    r, amplitude = random_orbits(np.random.default_rng(3), 20, lowest=0.3)
    errors = [
        exact_errors(SpringDamper(ratio, restitution=r), amplitude=amplitude, simple=Corrected)
        for ratio in (1000.0, 2000.0)
    ]
    for name in ("max_height", "bounce_velocity", "phase", "saddle_node", "period_doubling"):
        assert np.median(errors[0][name] / errors[1][name]) == pytest.approx(4, abs=0.1), name


def test_free_impact_of_a_restitution_that_falls_with_the_speed():
    """r = e^{-v/10}: r̂ = r(1 - v/10), and d²(rv)/dv² = r(v/100 - 1/5)."""
    impact = free_impact(Rigid(lambda v: np.exp(-v / 10)), n=2)
    r, v = impact.restitution, impact.speed
    assert (1 + r) * v == pytest.approx(4 * np.pi, rel=1e-14)
    assert impact.slope == pytest.approx(r * (1 - v / 10), rel=1e-14)
    # A central difference with a relative step of 1e-4 errs by its square.
    assert impact.curvature == pytest.approx(r * (v / 100 - 0.2), rel=1e-7)
    assert impact.duration == impact.load == 0


def test_doubling_of_a_restitution_that_falls_with_the_speed():
    """The closed form with r(v) against the multiplier -1 of the exact orbits."""
    ball = Rigid(lambda v: np.exp(-v / 20))
    closed = restitution_values(free_impact(ball), 1.0)
    exact = contact_values(ball, amplitude=1.0)
    for name in QUANTITIES:
        assert exact[name] == pytest.approx(closed[name], rel=1e-10), name


def test_stretched_impact_is_that_of_another_ratio():
    for release in ("displacement", "force"):
        ball = SpringDamper(10.0, damping_ratio=0.2, release=release)
        stretched = free_impact(ball).stretched(2.5)
        softer = free_impact(ball.at(frequency_ratio=4.0))
        np.testing.assert_allclose(stretched, softer, rtol=1e-12, atol=1e-9)


def test_law_thresholds_of_height_solve_the_quadratic_of_the_article():
    """Eq. R7, and that no error above the threshold exceeds the tolerance."""
    rng = np.random.default_rng(4)
    r, amplitude = random_orbits(rng, 200)
    # Next to the saddle-node some errors leave the tolerance upwards.
    amplitude[::2] = np.pi * (1 - r[::2]) / (1 + r[::2]) * (1 + 10 ** rng.uniform(-6, -1, 100))
    unit = SpringDamper(1.0, restitution=r)
    impact = free_impact(unit)
    thresholds = law_thresholds(unit, amplitude=amplitude, tolerance=0.01)
    line = impact.speed - np.pi
    shift = impact.load / (1 + r)
    rise = np.sqrt(amplitude**2 - line**2)
    height = rise + np.pi**2 / 2
    deeper = shift * line + impact.speed * impact.centroid
    u = 1 / thresholds["max_height"]
    defects = [
        (rise + error * height + deeper * u) ** 2 + (line - shift * u) ** 2 - amplitude**2
        for error in (-0.01, 0.01)
    ]
    assert np.abs(defects).min(axis=0).max() < 1e-12
    upwards = np.abs(defects).argmin(axis=0) == 1
    assert 10 < upwards.sum() < 100
    for factor in np.geomspace(1 + 1e-9, 1e5, 60):
        for name in ("max_height", "phase"):
            law = law_errors(
                SpringDamper(thresholds[name] * factor, restitution=r), amplitude=amplitude
            )[name]
            assert np.abs(law).max() <= 0.01


def test_exact_values_are_those_of_the_orbit():
    ball = SpringDamper(20.0, restitution=0.65)
    one = orbit(ball, amplitude=1.0)
    values = contact_values(ball, amplitude=1.0)
    for name in QUANTITIES[:4]:
        assert values[name] == pytest.approx(getattr(one, name), rel=1e-12)


def test_arrays_are_numbers_side_by_side():
    r, amplitude = np.array([0.3, 0.65, 0.9]), np.array([1.9, 1.0, 0.5])
    several = error_thresholds(SpringDamper(1.0, restitution=r), amplitude=amplitude)
    for i in range(3):
        alone = error_thresholds(SpringDamper(1.0, restitution=r[i]), amplitude=amplitude[i])
        for name in QUANTITIES:
            assert several[name].status[i] == alone[name].status
            assert several[name].ratio[i] == pytest.approx(
                alone[name].ratio, rel=1e-11, nan_ok=True
            )


def test_a_path_is_given_by_a_function():
    def contacts(ratio):
        return SpringDamper(ratio, restitution=0.65)

    known = {"amplitude": 1.0, "quantities": ["max_height"]}
    by_function = error_thresholds(contacts, **known)["max_height"].ratio
    assert by_function == pytest.approx(82.17735912, abs=1e-8)
    law = law_thresholds(contacts, amplitude=1.0)["max_height"]
    assert law == pytest.approx(82.17804393, abs=1e-8)


def test_statuses():
    """Too strict and too loose a tolerance, and an orbit that only stiff contacts have."""
    known = {"amplitude": 1.0, "quantities": ["max_height"], "high": 1e3}
    assert error_thresholds(BALL, tolerance=1e-6, **known)["max_height"].status == "exceeded"
    assert error_thresholds(BALL, tolerance=1.0, **known)["max_height"].status == "within"


def test_no_orbit_is_nan():
    law = law_errors(BALL, amplitude=0.5)
    assert np.isnan(law["max_height"]) and np.isfinite(law["saddle_node"])
    same = law_coefficients(BALL, amplitude=0.5, table=Table([(1, 1.0, 0.0)]))
    assert np.isnan(same["max_height"]) and np.isfinite(same["saddle_node"])
    assert np.isnan(contact_values(BALL.at(frequency_ratio=50.0), amplitude=0.5)["max_height"])


def test_solutions_that_are_no_orbits_are_left_out():
    """Newton's method ends on such ones of very lossy and compliant contacts."""
    ball = SpringDamper(
        np.array([2.371432, 1.057858, 2.148550]), restitution=[0.1773, 0.0752, 0.0996]
    )
    heights = contact_values(ball, amplitude=[1.136049, 2.440847, 1.047684])["max_height"]
    # The second height is that of a shooting by another integrator.
    assert heights == pytest.approx([np.nan, 2.003012598, np.nan], abs=1e-8, nan_ok=True)
    nodes = contact_values(Corrected(SpringDamper(2.0, restitution=0.05)), amplitude=1.0)
    assert not nodes["saddle_node"] < 0


@pytest.mark.parametrize(
    ("mistake", "named"),
    [
        ({"amplitude": -1.0}, "amplitude"),
        ({"amplitude": 1.0, "tolerance": 0}, "tolerance"),
        ({"amplitude": 1.0, "low": 10, "high": 1}, "low = 10, high = 1: must be positive, and low"),
        ({"amplitude": 1.0, "tolerance": "1 %"}, "tolerance = '1 %': must be a number"),
        ({"amplitude": 1.0, "quantities": ["height"]}, "height"),
    ],
)
def test_mistakes_are_one_line(mistake, named):
    with pytest.raises(ValueError, match=named) as raised:
        error_thresholds(BALL, **mistake)
    assert "\n" not in str(raised.value)


def test_below_the_saddle_node_there_is_no_threshold_of_an_orbit():
    below = 0.9 * np.pi * (1 - 0.65) / (1 + 0.65)
    by_law = law_thresholds(BALL, amplitude=below)
    exact = error_thresholds(BALL, amplitude=below)
    for name in QUANTITIES:
        of_orbit = name not in ("saddle_node", "period_doubling")
        assert np.isnan(by_law[name]) == of_orbit
        assert exact[name].status == ("no orbit" if of_orbit else "found")


def test_a_free_impact_may_be_given():
    impact = free_impact(BALL)
    assert isinstance(impact, FreeImpact)
    assert law_errors(impact, amplitude=1.0) == law_errors(BALL, amplitude=1.0)


LAWS = {
    law.__name__: law(restitution=0.65, duration=0.02, speed=2 * np.pi / 1.65)
    for law in (hunt_crossley, tsuji, kuwabara_kono)
}


@pytest.mark.parametrize("name", LAWS)
def test_law_of_other_contacts_is_of_second_order(name):
    """Along the duration of a contact of any law, whose units tell how it is stretched."""
    law = LAWS[name]
    remainders = []
    for ratio in (1.0, 2.0):
        ball = ball_at_ratio(law, 1, 0.01)(np.pi / 0.02 * ratio)
        impact = free_impact(ball)
        assert impact.restitution == pytest.approx(0.65, rel=1e-9)
        through = impact.centroid * 1.65 / 0.65
        assert through == pytest.approx(0.02 / ratio, rel=1e-9)
        by_law = law_errors(impact, amplitude=0.9)
        exact = exact_errors(ball, amplitude=0.9)
        remainders.append({quantity: exact[quantity] - by_law[quantity] for quantity in QUANTITIES})
    for quantity in QUANTITIES:
        # Terms of third order are some per cent of those of second order.
        assert remainders[0][quantity] / remainders[1][quantity] == pytest.approx(4, rel=0.08), (
            quantity
        )


def test_constant_restitution_misses_the_doubling():
    """By 2.9 % on a stiff contact of Hunt and Crossley, which the corrected model does not."""
    ball = hunt_crossley(restitution=0.65, duration=np.pi / 300, speed=2 * np.pi / 1.65)
    known = {"amplitude": 1.0, "quantities": ["period_doubling"]}
    constant = exact_errors(ball, simple=lambda contact: Rigid(0.65), **known)
    corrected = exact_errors(ball, simple=Corrected, **known)
    assert constant["period_doubling"] == pytest.approx(0.029, abs=5e-4)
    assert corrected["period_doubling"] == pytest.approx(3.6e-6, abs=5e-8)
    assert exact_errors(ball, **known)["period_doubling"] == pytest.approx(-5e-4, abs=1e-4)


def test_thresholds_of_a_law_are_by_its_duration():
    """For 1 % of the height the article has 81.23 for π/(D + κ) on this contact."""
    law = LAWS["hunt_crossley"]
    known = {"amplitude": 1.0, "quantities": ["max_height"], "low": 10, "high": 1000, "samples": 9}
    threshold = error_thresholds(law, **known)["max_height"]
    assert threshold.ratio == pytest.approx(81.23, abs=5e-3)
    assert law_thresholds(law, amplitude=1.0)["max_height"] == pytest.approx(
        threshold.ratio, rel=1e-3
    )


@pytest.mark.parametrize("name", ["linear", *LAWS])
def test_trace_and_determinant_of_the_corrected_model(name):
    """The balances and Eq. C1 of Appendix C, with derivatives of the signature by differences."""
    ball = SpringDamper(20.0, restitution=0.65) if name == "linear" else LAWS[name]
    one = orbit(Corrected(ball), amplitude=1.0)
    psi = one.times[0]
    v = np.pi + np.cos(psi)
    h = 1e-4
    speeds = v + h * np.array([-1, 0, 1])
    r, _, delay, sigma = ball.signature(speeds)
    a = 1 - np.sin(psi)
    leaving = np.diff(r * speeds + sigma * a)
    falling = np.diff(delay * speeds)
    g = leaving.sum() / (2 * h)
    t = falling.sum() / (2 * h)
    w = -np.sin(psi) - sigma[1] * np.cos(psi)
    n = v - t * a
    trace = (v + 2 * np.pi * w - t * (1 + w) + a * (2 * np.pi * g - t * (1 + g))) / n - g
    determinant = (2 * np.pi * g - g * v - t * (1 + w)) / n
    assert one.multipliers.sum() == pytest.approx(trace, abs=1e-6)
    assert one.multipliers.prod() == pytest.approx(determinant, abs=1e-6)
    doubling = (1 - g) * v + np.pi * (w + (1 + a) * g) - t * (1 + a + w)
    assert 1 + trace + determinant == pytest.approx(2 * doubling / n, rel=1e-12)


def test_an_elastic_ball_has_thresholds_but_no_saddle_node():
    """Its law has |K|/ε for the velocity, (D - t_c)/π with D - t_c = π/(2ϖ): 1/(2ε)."""
    elastic = SpringDamper(1.0, restitution=1.0)
    by_law = law_thresholds(elastic, amplitude=0.5)
    exactly = error_thresholds(elastic, amplitude=0.5)
    assert np.isnan(by_law["saddle_node"]) and np.isnan(exactly["saddle_node"].ratio)
    assert by_law["bounce_velocity"] == pytest.approx(50)
    assert exactly["bounce_velocity"].ratio == pytest.approx(50, rel=0.01)


def test_the_threshold_of_one_quantity_does_not_depend_on_the_others():
    both = error_thresholds(BALL, amplitude=1.0, quantities=["phase", "saddle_node"])
    (one,) = error_thresholds(BALL, amplitude=1.0, quantities=["phase"]).values()
    assert list(both) == ["phase", "saddle_node"]
    assert one.ratio == pytest.approx(both["phase"].ratio, rel=1e-10)  # 1e-12 from each search


def test_a_ball_that_leaves_slowly_has_the_values_of_its_orbit():
    """With r = 0.1 it leaves with a relative speed of half of g/Ω."""
    ball = SpringDamper(50.0, 0.1)
    known = orbit(ball, amplitude=2.8)
    assert known.relative_bounce_velocity < 1
    values = contact_values(ball, amplitude=2.8, quantities=["max_height", "phase"])
    assert values["max_height"] == pytest.approx(known.max_height, rel=1e-12)
    assert values["phase"] == pytest.approx(known.phase, rel=1e-12)


SKEWED = Table([(1, 1.0, 0.0), (3, 0.05, 0.7)])


@pytest.mark.parametrize("table", [SINE, SKEWED])
@pytest.mark.parametrize("r", [0.05, 0.3, 0.65, 0.95])
def test_errors_at_the_saddle_node_of_the_restitution_model_are_those_next_to_it(table, r):
    """Also if Λ differs from C/max w′ by rounding; the phase after the steepest rise is 0 there."""
    ball = SpringDamper(300.0, restitution=r)
    node = np.pi * (1 - r) / (1 + r) / table.slope
    amplitude = node * (1 + np.array([-1e-16, 0.0, 1e-16, 1e-15, 1e-12, 1e-10]))
    for errors in (law_errors, exact_errors):
        at_node = errors(ball, amplitude=amplitude, table=table)
        next_to_it = errors(ball, amplitude=node * (1 + 1e-9), table=table)
        for name in QUANTITIES:
            np.testing.assert_allclose(at_node[name], next_to_it[name], atol=1e-4, err_msg=name)


def test_orbits_at_their_saddle_node_are_found_on_both_sides():
    """By their closed form: the phase is zero, and the height that of a flight of 2π."""
    node = np.pi * 0.35 / 1.65
    for side in ("stable", "unstable"):
        periodic_orbit = orbit(Rigid(0.65), amplitude=node, side=side)
        assert periodic_orbit.phase == pytest.approx(0, abs=1e-6)
        assert (
            np.abs(periodic_orbit.equations.linearized(periodic_orbit.z[np.newaxis]).legs).max()
            < 1e-14
        )
    values = contact_values(Rigid(0.65), amplitude=node)
    assert values["max_height"] == pytest.approx(np.pi**2 / 2, abs=1e-6)

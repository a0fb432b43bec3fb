"""The criticality of bifurcations, against closed forms, 40 digits and simulation."""

import math
from functools import partial

import mpmath as mp
import numpy as np
import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of
from bouncing_ball_beyond.periodic.orbits.return_map import returned


def _one_impact(ball, amplitude):
    return partial(bouncing_ball_beyond.orbit, ball, amplitude=amplitude)


def _three_impacts():
    """The orbit of a compliant contact whose doubling at Λ = 1.379 is subcritical."""
    ball = bouncing_ball_beyond.spring_damper(frequency_ratio=3.4, damping_ratio=0.1)
    three = bouncing_ball_beyond.orbit_of_motion(ball, amplitude=1.3)
    assert three.impacts == three.periods == 3
    return three


def _doubling(orbit, to):
    return bouncing_ball_beyond.follow(orbit, to=to).first("period doubling")


# An orbit, the Λ beyond its doubling, and whether this is supercritical.
DOUBLINGS = [
    (_one_impact(bouncing_ball_beyond.rigid(restitution=0.5), 1.4), 1.8, True),
    (_three_impacts, 1.5, False),
]


@pytest.mark.parametrize("n", [1, 2])
@pytest.mark.parametrize("r", [0.3, 0.8])
def test_the_saddle_node_of_the_restitution_model_is_that_of_its_closed_form(r, n):
    """Λ cos φ = nπ(1 - r)/(1 + r), so that φ² = 2 dΛ/Λ next to φ = 0, where δ′ is the same on the
    whole branch: ξ = φ, and -rate/a = 2/Λ. The flight lands at φ + 2πn + (1 + r) dφ-terms; the
    second derivative by φ at fixed δ′ follows from Λ sin φ alone.
    """
    ball = bouncing_ball_beyond.rigid(restitution=r)
    fold, _ = bouncing_ball_beyond.limits(ball, n)
    found = bouncing_ball_beyond.normal_form(fold)
    lam = n * math.pi * (1 - r) / (1 + r)
    assert found.direction == pytest.approx((1.0, 0.0), abs=1e-12)
    assert -found.rate / found.coefficient == pytest.approx(2 / lam, rel=1e-9)
    assert found.opens_upwards and found.other == pytest.approx(r * r, rel=1e-12)
    assert found.error < 1e-10 * abs(found.coefficient)


def test_a_state_of_which_newtons_method_finds_no_landing_does_not_return():
    r, lam = 0.5, 1.4
    one = bouncing_ball_beyond.orbit(bouncing_ball_beyond.rigid(restitution=r), amplitude=lam)
    problem, y = equations_of(one)
    aside = np.random.default_rng(0).uniform([-3.0, -3.0], [3.0, 4.0], (2000, 2))
    distance = returned(problem, y, aside).distance
    lands = np.isfinite(distance).all(axis=-1)
    assert 0 < np.count_nonzero(~lands) < 100
    phase = one.phase + aside[lands, 0]
    up = lam * np.cos(phase) - r * (one.relative_impact_velocity + aside[lands, 1])
    # The flight may last several turns of the table.
    turned = one.phase + distance[lands, 0] - phase
    time = turned + 2 * np.pi * np.arange(-1, 4)[:, np.newaxis]
    gap = lam * np.sin(phase) + (up - time / 2) * time - lam * np.sin(phase + time)
    # A hundred roundings of heights of order ten.
    assert np.abs(gap).min(axis=0).max() < 1e-12


def _map_in_digits(r, lam):
    """The return map of the restitution model near one period, (φ, δ′) → (φ - 2π, δ′)."""

    def image(phase, velocity):
        up = -r * velocity + lam * mp.cos(phase)

        def gap(t):
            return lam * mp.sin(phase) + up * t - t * t / 2 - lam * mp.sin(phase + t)

        t = mp.findroot(gap, 2 * mp.pi)
        return phase + t - 2 * mp.pi, up - t - lam * mp.cos(phase + t)

    return image


def test_the_coefficient_of_a_doubling_is_that_of_forty_digits():
    """The third derivative of F∘F along its centre manifold: with the slow coordinate ξ the twice
    returned ξ is ξ - 2 b ξ³ + … on the doubling, whatever the fast coordinate does. The manifold is
    found by the graph transform, in which the fast deviation shrinks by the other multiplier.
    """
    doubling = _doubling(
        bouncing_ball_beyond.orbit(bouncing_ball_beyond.rigid(restitution=0.5), amplitude=1.4), 1.8
    )
    found = bouncing_ball_beyond.normal_form(doubling)
    with mp.workdps(40):
        r = mp.mpf("0.5")
        # The doubling in closed form: (1 + r)² Λ sin φ = 2 (1 + r²) and Eq. 6.
        along = mp.pi * (1 - r) / (1 + r)
        across = 2 * (1 + r * r) / (1 + r) ** 2
        lam = mp.sqrt(along**2 + across**2)
        phase = mp.atan2(across, along)
        velocity = -2 * mp.pi / (1 + r)
        assert abs(float(lam) - doubling.amplitude) < 1e-12
        image = _map_in_digits(r, lam)

        def slow(xi):
            """The slow coordinate after two returns, p·(F²(x) - x₀), on the centre manifold."""
            slopes = mp.matrix(2, 2)
            for j in range(2):
                for i in range(2):
                    at = [phase, velocity]

                    def entry(x, i=i, j=j, at=at):
                        point = list(at)
                        point[j] = x
                        return image(*point)[i]

                    slopes[i, j] = mp.diff(entry, at[j])
            values, right = mp.eig(slopes)
            k = 0 if abs(values[0] + 1) < abs(values[1] + 1) else 1
            q = right[:, k] / mp.norm(right[:, k])
            w = right[:, 1 - k]
            basis = mp.matrix([[q[0], w[0]], [q[1], w[1]]])
            inverse = basis**-1

            # Starts off the manifold by c ξ²: its slow coordinate is that of the map after the fast
            # deviation is removed, so that c solves the graph equation h(ξ) = λ h(-ξ) + g ξ².
            def both(xi, eta):
                x = basis * mp.matrix([xi, eta])
                f = image(phase + x[0], velocity + x[1])
                return inverse * mp.matrix([f[0] - phase, f[1] - velocity])

            other = values[1 - k]
            g = mp.diff(lambda s: both(s, 0)[1], 0, 2) / 2
            c = g / (1 - other)
            first = both(xi, c * xi * xi)
            return first[0]

        # On the manifold F: ξ → -ξ + α ξ² + β ξ³, and b = α² + β.
        alpha = mp.diff(slow, 0, 2) / 2
        beta = mp.diff(slow, 0, 3) / 6
        expected = float(mp.re(alpha**2 + beta))
    assert found.coefficient == pytest.approx(expected, abs=2 * found.error + 1e-9)
    assert found.error < 1e-9


@pytest.mark.parametrize(
    ("start", "to", "supercritical"),
    [
        *DOUBLINGS,
        (
            _one_impact(
                bouncing_ball_beyond.spring_damper(restitution=0.6, frequency_ratio=8.0), 1.2
            ),
            1.8,
            True,
        ),
    ],
)
def test_doubled_orbits_are_where_the_normal_form_has_them(start, to, supercritical):
    doubling = _doubling(start(), to)
    found = bouncing_ball_beyond.normal_form(doubling)
    assert found.is_supercritical is supercritical is found.opens_upwards
    to = doubling.amplitude + (0.2 if supercritical else -0.2)
    twice = next(bouncing_ball_beyond.follow(doubling, to=to, points=12).states())
    change = twice.amplitude - doubling.amplitude
    assert (change > 0) is supercritical and twice.is_stable() is supercritical
    # Half the distance of the two turns at the first impact is ξ q, up to ξ³.
    k = doubling.impacts
    aside = np.array(
        [
            twice.phases[0] - twice.phases[k],
            twice.relative_impact_velocity[0] - twice.relative_impact_velocity[k],
        ]
    )
    xi = np.linalg.norm(aside) / 2
    assert xi**2 == pytest.approx(found.rate * change / found.coefficient, rel=60 * xi**2 + 0.02)


@pytest.mark.parametrize(("start", "to", "supercritical"), DOUBLINGS)
def test_simulated_balls_on_both_sides_of_a_doubling_do_what_the_normal_form_says(
    start, to, supercritical
):
    orbit = start()
    doubling = _doubling(orbit, to)
    found = bouncing_ball_beyond.normal_form(doubling)
    # The rates are proportional to it, so that fewer impacts are seen with a larger one.
    share = 3e-3
    size = math.sqrt(abs(found.rate * share / found.coefficient))
    # The change of Λ and ξ of each ball at the first impact, over the share and the size.
    starts = [(1, 0.2), (-1, 2.0)] if supercritical else [(-1, 0.5), (-1, 1.5), (1, 0.1)]
    lam = []
    phase = []
    velocity = []
    at = []
    for side, xi in starts:
        here = doubling.amplitude + side * share
        *_, one = bouncing_ball_beyond.follow(orbit, to=here).states()
        lam.append(here)
        at.append(one.phases[0])
        phase.append(one.phases[0] + xi * size * found.direction[0])
        relative = np.ravel(one.relative_impact_velocity)[0] + xi * size * found.direction[1]
        velocity.append(float(relative + here * np.cos(phase[-1])))
    # |ξ q| of each ball at each turn, from the orbit on.
    turns = 2000 if supercritical else 1400
    followed = orbit.model.simulate(lam, phase, velocity, turns * doubling.impacts + 1)
    aside = np.abs(reduce_angle(followed.phase[:: doubling.impacts] - np.array(at))).T
    if supercritical:
        # Beyond the doubling small and large deviations end on the doubled orbit, before it none.
        beyond, before = aside
        assert beyond[-1] == pytest.approx(size * abs(found.direction[0]), rel=0.1)
        assert before[-1] < 1e-6
    else:
        # Before the doubling the unstable doubled orbit is the border of the basin. A ball that
        # leaves may come back much later.
        inside, outside, beyond = aside
        assert inside[-1] < 0.1 * size
        assert outside.max() > 2 * size
        assert beyond.max() > 2 * size


def test_the_doublings_on_both_sides_of_a_generalized_one_differ():
    doubling = _doubling(_three_impacts(), 1.5)
    both = "amplitude", "restitution"
    curve = bouncing_ball_beyond.follow(
        doubling, along=both, ranges={"restitution": (0.72, 0.79)}
    ).to_dataset()
    assert curve.special_kind.values.tolist() == ["generalized period doubling"]
    border = float(curve.special_restitution[0])
    forms = [
        (s.parameters["restitution"], bouncing_ball_beyond.normal_form(s)) for s in curve.states()
    ]
    assert {form.is_supercritical for r, form in forms if r > border} == {True}
    assert {form.is_supercritical for r, form in forms if r < border} == {False}
    # A saddle-node of the doubled orbits leaves from the generalized doubling on the subcritical
    # side, and moves away from the doublings with the square of the distance.
    apart = []
    for r in (border - 0.001, border - 0.002):
        up_to = bouncing_ball_beyond.follow(doubling, along=both, ranges={"restitution": (0.72, r)})
        there = max(up_to.states(), key=lambda each: each.parameters["restitution"])
        twice = bouncing_ball_beyond.follow(there, along="amplitude", to=0.99 * there.amplitude)
        apart.append(there.amplitude - twice.first("saddle-node").amplitude)
    assert 0 < apart[0] and apart[1] / apart[0] == pytest.approx(4, rel=0.1)


def test_no_contact_turns_areas_over_so_that_no_fold_flip_exists():
    for ball in (
        bouncing_ball_beyond.rigid(restitution=0.5),
        bouncing_ball_beyond.spring_damper(restitution=0.5, frequency_ratio=5.0),
        bouncing_ball_beyond.contact_law("hunt-crossley", stiffness=1e4, damping=0.1),
    ):
        fold, _ = bouncing_ball_beyond.limits(ball)
        assert fold.trace_and_determinant()[1] > 0
        assert bouncing_ball_beyond.normal_form(fold).other > 0


def test_an_orbit_without_a_bifurcation_has_no_normal_form(refusal):
    one = bouncing_ball_beyond.orbit(bouncing_ball_beyond.rigid(restitution=0.5), amplitude=1.4)
    with refusal(NoOrbitError, "normal_form needs a saddle-node or a period doubling"):
        bouncing_ball_beyond.normal_form(one)
    with refusal(NoOrbitError, "normal_form needs a saddle-node or a period doubling"):
        bouncing_ball_beyond.normal_form(SpringDamper(10.0, 0.1))
    fold, _ = bouncing_ball_beyond.limits(bouncing_ball_beyond.rigid(restitution=0.5))
    with refusal(NoOrbitError, "a saddle-node is neither supercritical nor subcritical"):
        bouncing_ball_beyond.normal_form(fold).is_supercritical  # noqa: B018

"""What every model of the impact keeps, whatever its law.

A new model is one more line of :data:`MODELS`; ``plastic_impact.py`` beside this
file is an example of one. Tolerances are roundings, of
times some 2πn and of velocities some nπ, grown by the quantity that is named
beside them.
"""

import runpy
from functools import cache, partial
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from loaded_laws import Sharing

from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError
from bouncing_ball_beyond.inherited.numerics.corrector import NewtonSettings, newton
from bouncing_ball_beyond.inherited.periodic.orbit import OBSERVABLES, Bifurcation, Side
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.elasto_backlash import ElastoBacklash
from bouncing_ball_beyond.models.laws.hertzian import KuwabaraKono, Tsuji
from bouncing_ball_beyond.models.laws.loaded import under
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.laws.stepped import AdamsImpact, SimscapeContact
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.branches.following import orbits_on
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.one_impact.searched_orbits import SearchedOrbits
from bouncing_ball_beyond.periodic.orbits.motion import contact_motion, contact_path
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.special import bifurcations as events_of

EPS = np.finfo(float).eps
COMPLIANT = SpringDamper.from_restitution(0.85, 4.0)
STIFF = SpringDamper.from_restitution(0.65, 50.0)
PUSHING = SpringDamper.from_restitution(0.65, 20.0, "force")
HERTZ = {
    "tsuji": Tsuji(500.0, 0.3),
    "kuwabara-kono": KuwabaraKono(2e3, 0.008),
    "sharing": Sharing(15.0, 0.1),
    "elasto-backlash": ElastoBacklash(15.0, 0.1),
    "adams-impact": AdamsImpact(2e3, 4.0, 0.02),
    "simscape-contact": SimscapeContact(225.0, 3.0, 0.02),
    "hardening spring": runpy.run_path(str(Path(__file__).with_name("hardening_spring.py")))["LAW"],
}
# Of contacts and their derivatives: roundings, but for the laws without a closed form,
# where it is the collocation's convergence, and of a simulated cycle its own tolerance, 1e-12
# of the velocity in each of some ten steps.
EXACT = {name: 1e-12 for name in HERTZ}
SIMULATED = {name: 1e-11 for name in HERTZ}
OWN = runpy.run_path(str(Path(__file__).with_name("plastic_impact.py")))
MODELS = {
    "restitution": RestitutionModel(0.65),
    "elastic": RestitutionModel(1.0),
    "compliant contact": ContactModel(COMPLIANT),
    "stiff contact": ContactModel(STIFF),
    "force release": ContactModel(PUSHING),
    "undamped contact": ContactModel(SpringDamper(10.0, 0.0)),
    "corrected": CorrectedModel.of_contact(STIFF),
    "corrected, force release": CorrectedModel.of_contact(PUSHING),
    "corrected, kuwabara-kono": CorrectedModel(Signature(HERTZ["kuwabara-kono"])),
    **{name: ContactModel(law) for name, law in HERTZ.items()},
    "one's own": OWN["MODEL"],
}
# Other laws of the same model: one of them is tried often, and the others weekly.
SELDOM = ("kuwabara-kono", "elasto-backlash", "sharing", "adams-impact", "simscape-contact")
# Of these some tests take seconds, and "tsuji" and "corrected" are of the same kinds.
SLOW = (*SELDOM, "corrected, kuwabara-kono", "hardening spring")
DISSIPATIVE = [name for name in MODELS if name not in ("elastic", "undamped contact")]
# n, and Λ over the saddle-node's and below the table's grazing, Λ > 1 included.
CASES = [(1, 0.3), (2, 0.3), (1, 0.6)]
# Every n, every Λ and either side with each model; all of them together weekly.
TRIED = [((1, 0.3), Side.STABLE), ((2, 0.3), Side.UNSTABLE), ((1, 0.6), Side.UNSTABLE)]


def often(names, seldom=SELDOM):
    """Names of models as parameters, some of them of long tests only."""
    return [pytest.param(x, marks=pytest.mark.long if x in seldom else ()) for x in names]


def cases(names):
    """All cases of models by their names, each on both sides, most of them of long tests only."""
    found = []
    for name, case, side in product(names, CASES, Side):
        seldom = name in SELDOM or (case, side) not in TRIED
        marks = pytest.mark.long if seldom else ()
        found.append(pytest.param((name, case, side), id=f"{name}-{case}-{side}", marks=marks))
    return found


CLOSED = [name for name, model in MODELS.items() if model.name in ("restitution", "spring-damper")]
every_model = pytest.mark.parametrize("name", often(MODELS))
each_kind = pytest.mark.parametrize("name", often(MODELS, SLOW))
every_side = pytest.mark.parametrize("side", list(Side))


@cache
def bifurcations(name, n):
    return n_t.saddle_node(MODELS[name], n), n_t.period_doubling(MODELS[name], n)


@cache
def some_orbit(name, n, above, side):
    model = MODELS[name]
    node = float(bifurcations(name, n)[0].amplitude)
    return n_t.require_orbit(model, n, (0.0 if np.isnan(node) else node) + above, side)


@pytest.fixture(params=cases(MODELS))
def some(request):
    """Name, model, n, and an orbit: of every model in every case on every side."""
    name, (n, above), side = request.param
    return name, MODELS[name], n, some_orbit(name, n, above, side)


def differences(function, y, steps):
    """Central differences of fourth order along every entry of y, last axis."""
    weights = np.array([1, -8, 8, -1]) / 12
    columns = []
    for k, step in enumerate(steps):
        moved = [y + j * step * np.eye(len(y))[k] for j in (-2, -1, 1, 2)]
        columns.append(sum(w * function(x) for w, x in zip(weights, moved, strict=True)) / step)
    return np.stack(columns, axis=-1)


def test_an_orbit_solves_its_equations(some):
    _, _, n, orbit = some
    # Heights of order (nπ)²; a contact's phase ϖD, about π, is rounded too.
    size = (1 + np.pi * n) ** 2 * (1 + (np.pi if orbit.contact_duration > 0 else 0))
    assert orbit.defect() < 100 * EPS * size
    system = PaperUnknowns.of(orbit)
    y = system.point(orbit)
    assert np.max(np.abs(system.residual(y))) < 100 * EPS * size
    assert orbits_on(system, y).distance(orbit) < 100 * EPS * size


def test_the_jacobian_is_the_derivative_of_the_equations(some):
    name, _, _, orbit = some
    system = PaperUnknowns.of(orbit)
    y = system.point(orbit)
    computed = system.jacobian(y)
    # Fourth order: h⁴/30 = 3e-14 times a fifth derivative, and roundings over h. The column of Λ is
    # a central difference of 6e-6, of whose roundings a hundred make a residual.
    expected = differences(system.residual, y, np.full(len(y), 1e-3))
    missed = 1e-9 + EXACT.get(name, 100 * EPS) / 6e-6
    assert np.abs(computed - expected).max() < missed * (1 + np.abs(computed).max())


def test_an_orbit_is_a_fixed_point_of_the_simulation(some):
    name, model, n, orbit = some
    assert orbit.is_admissible()
    u = orbit.relative_impact_velocity
    growth = 1 + np.abs(orbit.monodromy()).max()
    cycle = model.cycle(orbit.amplitude, orbit.phase, u)
    rounding = SIMULATED.get(name, 100 * EPS * 2 * np.pi * n)
    assert abs(cycle.time - 2 * np.pi * n) < rounding * growth
    assert abs(cycle.relative_velocity - u) < rounding * growth
    sequence = model.simulate(orbit.amplitude, orbit.phase, orbit.impact_velocity, 2)
    missed = SIMULATED.get(name, 1e-12)
    assert sequence.time[1] == pytest.approx(2 * np.pi * n, abs=missed * growth)
    assert sequence.contact_duration[0] == pytest.approx(orbit.contact_duration, abs=1e-13 * growth)


def test_the_monodromy_is_the_jacobian_of_the_simulated_map(some):
    _, model, _, orbit = some
    dynamics = model.dynamics(orbit.amplitude)
    section = dynamics.section()

    def cycle(state):
        impact = section.impact(*state[:, np.newaxis])
        after, passed = dynamics.fly(dynamics.depart(impact))
        # The time runs on where the phase is reduced.
        later = passed + section.delay(after) - section.delay(impact)
        return np.array([state[0] + later[0], section.state(after)[1][0]])

    start = dynamics.start(orbit.phases, np.array([orbit.relative_impact_velocity]))
    state = np.array(section.state(start))[:, 0]
    expected = differences(cycle, state, np.full(2, 1e-3 * min(1.0, abs(state[1]))))
    computed = orbit.monodromy()
    assert np.abs(computed - expected).max() < 1e-8 * (1 + np.abs(computed).max() ** 2)


# Other models do not need these derivatives.
@pytest.mark.parametrize(
    "some", cases(x for x in MODELS if MODELS[x].name == "spring-damper"), indirect=True
)
def test_the_slopes_of_a_duration_are_the_derivatives_of_the_contact(some):
    # Where the force vanishes the map does not feel the time of release, so that
    # the monodromy would not show an error in it.
    _, model, _, orbit = some

    lam = orbit.amplitude

    def contact(state):
        phase, relative = state
        end = model.simulate(lam, phase, relative + lam * np.cos(phase), 1)
        return end.contact_duration

    state = np.array([orbit.phase, orbit.relative_impact_velocity])
    expected = differences(contact, state, np.full(2, 1e-3))[0]
    dynamics = model.dynamics(lam)
    impact = dynamics.start(*state[:, np.newaxis])
    near = dynamics.depart(impact).duration
    found = np.ravel(dynamics.depart(impact, near=near).slopes)
    assert np.abs(found - expected).max() < 1e-9 * (1 + np.abs(expected).max())


def test_the_determinant_is_the_contraction(some):
    name, _, _, orbit = some
    matrix = orbit.monodromy()
    size = 1 + np.abs(matrix).max() ** 2
    missed = EXACT.get(name, 100 * EPS)
    assert abs(np.linalg.det(matrix) - orbit.trace_and_determinant()[1]) < missed * size
    trace, det = orbit.trace_and_determinant()
    assert abs(np.trace(matrix) - trace) < 100 * EPS * size
    product = np.prod(orbit.multipliers())
    assert abs(product - det) < 100 * EPS * size
    # Without dissipation the multipliers lie on the circle, and rounding decides.
    if name in DISSIPATIVE:
        assert bool(orbit.is_stable()) == bool(np.all(np.abs(orbit.multipliers()) < 1))


# The bifurcations depend on n alone.
@pytest.mark.parametrize(("n", "above"), [(1, 0.6), (2, 0.3)])
@pytest.mark.parametrize("name", often(DISSIPATIVE))
def test_the_orbits_at_the_bifurcations_have_a_multiplier_plus_or_minus_one(name, n, above):
    model = MODELS[name]
    node, doubling = bifurcations(name, n)
    # The multiplier at a fold is as exact as the root of its distance to 1.
    assert np.min(np.abs(node.multipliers() - 1)) < 1e-6
    assert np.min(np.abs(doubling.multipliers() + 1)) < 1e-6
    between = n_t.orbit(model, n, (node.amplitude + doubling.amplitude) / 2)
    assert between.is_stable()
    assert not n_t.orbit(model, n, node.amplitude + 0.01 * above, Side.UNSTABLE).is_stable()
    # The continuation's own extended system meets them.
    for kind, orbit in zip(Bifurcation, (node, doubling), strict=True):
        system = PaperUnknowns.of(orbit)
        event = next(each for each in events_of(system.equations) if each.name == kind)
        start = system.point(orbit) * (1 + 1e-4)
        settings = NewtonSettings(max_iterations=40)
        found = newton(system, start, system.event(event).condition, settings)
        assert found.converged
        # The test functions' rounding over their slope, of order one.
        assert abs(found.point[-1] - orbit.amplitude) < 1e-9


def test_the_path_is_continuous_and_closed(some):
    name, _, n, orbit = some
    period = 2 * np.pi * n
    duration = float(orbit.contact_duration)
    height, velocity = orbit.path([0.0, period, -period, 5 * period])
    np.testing.assert_allclose(height, height[0], rtol=0, atol=1e-12 * n * n)
    # The corrected model meets the table's level to second order in the delay only.
    _, impact = orbit.starts
    delay = float(impact.known.instant.delay[0]) if name.startswith("corrected") else 0.0
    missed = 1e-12 + (1 + orbit.amplitude) * delay**2
    assert height[0] == pytest.approx(orbit.amplitude * np.sin(orbit.phase), abs=missed)
    np.testing.assert_allclose(velocity, velocity[0], rtol=0, atol=1e-12 * n)
    # Velocities are the slopes, but at impacts that are instants.
    time = np.linspace(0, period, 403)[1:-1]
    h = 1e-4
    instants = [0.0, duration, period, delay]
    clear = np.min(np.abs(time[:, None] - instants), axis=1) > 2 * h
    slope = (orbit.path(time + h)[0] - orbit.path(time - h)[0]) / (2 * h)
    # Second order: h²/6 times the third derivative of the height, ϖ² and more.
    clock = np.pi / duration if duration > 0 else 1.0
    assert np.abs(slope - orbit.path(time)[1])[clear].max() < h * h * (1 + clock) ** 3
    for end in (duration, period):
        before, after = (orbit.path(end + s * 1e-9)[0] for s in (-1, 1))
        assert abs(before - after) < 1e-7
    # The flight keeps its energy, and is what lifts these balls highest.
    flying = np.linspace(duration, period, 50)[1:-1]
    z, v = orbit.path(flying)
    assert v[0] > 0
    np.testing.assert_allclose(v * v / 2 + z, orbit.max_height, rtol=100 * EPS)


def test_the_ball_is_held_in_contact_and_above_the_table_in_flight(some):
    # First events: the ball is held in contact, and above the table in flight.
    _, _, _, orbit = some
    share = np.linspace(0, 1, 2001)[1:-1]
    law = orbit.law
    if isinstance(law, ContactLaw):
        depth, rate = (-x for x in contact_motion(orbit, share * orbit.contact_duration))
        angle = orbit.phase + share * orbit.contact_duration
        assert np.all(under(law, 1 - orbit.amplitude * np.sin(angle)).grip(depth, rate) > 0)
    time = float(orbit.contact_duration) + share * float(orbit.flight_time)
    gap = orbit.path(time)[0] - orbit.amplitude * np.sin(orbit.phase + time)
    rising = gap > 0
    end = contact_path(orbit, orbit.contact_duration)[0]
    if end < orbit.amplitude * np.sin(orbit.release_phase):
        # Let go below the table's level: it crosses it once, upwards.
        rising = rising[np.argmax(rising) :]
        assert len(rising) > len(gap) / 2
    assert np.all(rising)


@each_kind
def test_arrays_are_their_elements(name):
    model = MODELS[name]
    amplitude = np.array([[0.01], [1.0]])
    orbits = n_t.orbit(model, np.array([1, 2]), amplitude)
    assert orbits.shape == (2, 2) and len(orbits) == 2
    for k in np.ndindex(2, 2):
        single = n_t.orbit(model, k[1] + 1, amplitude[k[0], 0])
        one = orbits[k]
        for quantity in OBSERVABLES:
            assert getattr(one, quantity) == pytest.approx(
                getattr(single, quantity), rel=1e-11, nan_ok=True
            )
    there = orbits[orbits.exists]
    assert there.size == orbits.exists.sum() > 0
    # The orbits known by their numbers are the same ones.
    values = (there.amplitude, there.phase, there.contact_duration, there.impact_velocity)
    known = Orbit.of(model, there.n, *values)
    np.testing.assert_allclose(known.bounce_velocity, there.bounce_velocity)


@pytest.mark.parametrize("name", often(DISSIPATIVE, SLOW))
def test_both_sides_are_among_all_orbits_at_an_amplitude(name):
    model = MODELS[name]
    found = n_t.orbits(model, 1, 0.9)
    assert np.all(np.diff(found.contact_duration) >= 0)
    for side in Side:
        assert np.min(found.distance(n_t.orbit(model, 1, 0.9, side))) < 1e-9
    assert n_t.orbits(model, 1, 1e-3).size == 0


@each_kind
def test_a_side_may_be_given_by_its_name(name):
    model = MODELS[name]
    for side in Side:
        named = n_t.orbit(model, 1, 0.9, str(side))
        assert named.distance(n_t.orbit(model, 1, 0.9, side)) == 0
        assert n_t.absence(model, 1, 0.9, str(side)) == n_t.absence(model, 1, 0.9, side)


@pytest.mark.parametrize("name", [x for x in DISSIPATIVE if n_t.orbits_of(MODELS[x]).is_complete])
def test_a_closed_form_is_what_the_continuation_finds(name):
    model = MODELS[name]
    search = SearchedOrbits(model)
    n = np.array([1, 2])
    for kind, known in zip(Bifurcation, (n_t.saddle_node, n_t.period_doubling), strict=True):
        exact = known(model, n)
        # The test functions' rounding over their slope, of order one.
        np.testing.assert_allclose(
            search.bifurcation(n, kind).amplitude, exact.amplitude, rtol=1e-9
        )
    lam = n_t.saddle_node(model, n).amplitude + np.array([[1e-3], [0.3], [0.8]])
    for side in Side:
        found = search.orbit(n, lam, side)
        exact = n_t.orbit(model, n, lam, side)
        assert found.exists.tolist() == exact.exists.tolist()
        # Next to the fold a rounding of Λ is its root in the phase.
        assert np.nanmax(found.distance(exact)) < 1e-10
    # A closed form may know orbits with long contacts that no branch from here leads to.
    exact = n_t.orbits(model, 1, 0.9)
    for orbit in map(search.orbits(1, 0.9).__getitem__, range(2)):
        assert np.min(orbit.distance(exact)) < 1e-10
    assert np.isnan(search.orbit(1, 1e-3, Side.STABLE).phase)


@each_kind
def test_a_wrong_index_and_an_orbit_below_the_fold_are_refused(name):
    model = MODELS[name]
    for n in (0, -1, 1.5, np.nan):
        for ask in (n_t.saddle_node, n_t.period_doubling, partial(n_t.orbit, amplitude=1.0)):
            with pytest.raises(ModelError, match="not a positive integer"):
                ask(model, n)
    if name in DISSIPATIVE:
        with pytest.raises(NoOrbitError, match=r"Λ = 0\.001 .*below the saddle-node"):
            n_t.require_orbit(model, 1, 1e-3)
    assert model.permanent_contact_threshold() > 0


@pytest.mark.parametrize("n", [1, 3])
def test_the_orbits_of_a_simple_restitution_law_are_those_found_by_hand(n):
    # With v = w⁴ the speed of the orbits, v + r v = 2πn, is w⁴ + c^¼ w³ = 2πn, for v > c.
    model = OWN["MODEL"]
    c = 0.7**0.25
    w = max(np.roots([1, c, 0, 0, -2 * np.pi * n]).real)
    level = w**4 - np.pi * n
    r = c / w
    # d(r v)/dv = 3r/4, and 1 + tr + det = 0 at Λ sin φ = 2(1 + ¾r²)/((1 + r)(1 + ¾r)).
    lift = 2 * (1 + 0.75 * r * r) / ((1 + r) * (1 + 0.75 * r))
    assert float(n_t.saddle_node(model, n).amplitude) == pytest.approx(level, rel=1e-12)
    assert float(n_t.period_doubling(model, n).amplitude) == pytest.approx(np.hypot(level, lift))
    orbit = n_t.orbit(model, n, level + 0.5)
    assert float(orbit.phase) == pytest.approx(np.arccos(level / (level + 0.5)), rel=1e-12)
    assert float(orbit.apparent_restitution) == pytest.approx(r, rel=1e-12)


def test_each_impact_of_a_simulation_has_its_own_restitution():
    found = OWN["MODEL"].simulate(0.4, np.array([0.0, 1.0]), np.array([-3.0, -5.0]), 30)
    speed = -found.relative_velocity
    expected = np.minimum(1.0, (0.7 / speed) ** 0.25)
    np.testing.assert_allclose(found.relative_bounce_velocity / speed, expected, rtol=1e-12)
    assert np.ptp(expected) > 0.1

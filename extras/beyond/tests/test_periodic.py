"""Periodic orbits against closed forms, an integrator with events, and the replication."""

import re
import warnings
from functools import cache

import numpy as np
import pytest
from integrated import around, contact

from bouncing_ball.continuation import upper_orbits
from bouncing_ball.orbits import OBSERVABLES, Family
from bouncing_ball.spring_damper import Contact, damping_ratio
from bouncing_ball_beyond.contacts import root_time
from bouncing_ball_beyond.contacts.balls import Corrected, Rigid, SpringDamper, brief
from bouncing_ball_beyond.contacts.named_laws import hunt_crossley, kuwabara_kono, tsuji
from bouncing_ball_beyond.contacts.root_time import solve_panel
from bouncing_ball_beyond.errors.error_law import (
    contact_values,
    error_thresholds,
    exact_errors,
    free_impact,
    law_errors,
    law_thresholds,
)
from bouncing_ball_beyond.motions import bounces, effort
from bouncing_ball_beyond.motions.bounces import Balls, bounce
from bouncing_ball_beyond.motions.long_term import basins, lyapunov, motion_of
from bouncing_ball_beyond.periodic.chains import dense, solve_bordered
from bouncing_ball_beyond.periodic.continuation import follow, limits
from bouncing_ball_beyond.periodic.equations import OrbitEquations
from bouncing_ball_beyond.periodic.march import newton
from bouncing_ball_beyond.periodic.orbits import (
    OrbitNotFound,
    PeriodicOrbit,
    orbit,
    orbits,
)
from bouncing_ball_beyond.tables.table import Table

# Rounding errors of an orbit: some hundred times eps for numbers up to 20.
ROUNDED = 1e-12
# An integrator with the tolerance 1e-13 over some hundred steps.
INTEGRATED = 1e-9

RNG = np.random.default_rng(78)


@pytest.mark.parametrize("n", [1, 2, 3])
def test_the_orbits_of_the_restitution_model_are_its_closed_form(n):
    """cos φ = nπ(1 - r)/(1 + r)/Λ, tr = 1 + r² - (1 + r)² Λ sin φ and det = r²."""
    r = RNG.uniform(0.2, 0.95, 20)
    x = n * np.pi * (1 - r) / (1 + r)
    amplitude = np.hypot(x, RNG.uniform(0.1, 1.5, 20))
    for side, sign in (("stable", 1), ("unstable", -1)):
        periodic_orbits = orbit(Rigid(r), amplitude=amplitude, n=n, side=side)
        phase = sign * np.arccos(x / amplitude)
        trace = 1 + r**2 - (1 + r) ** 2 * amplitude * np.sin(phase)
        for i, periodic_orbit in enumerate(periodic_orbits):
            assert periodic_orbit.phase == pytest.approx(phase[i], abs=ROUNDED)
            # The first impact is in the first period of the table.
            assert periodic_orbit.times[0] == pytest.approx(phase[i] % (2 * np.pi), abs=ROUNDED)
            assert periodic_orbit.speeds[0] == pytest.approx(
                2 * np.pi * n / (1 + r[i]), abs=ROUNDED
            )
            expected = trace[i], r[i] ** 2
            assert periodic_orbit.trace_and_determinant == pytest.approx(
                expected, abs=100 * ROUNDED
            )
            assert periodic_orbit.stable == (abs(trace[i]) < 1 + r[i] ** 2)


@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("n", [1, 2])
def test_the_orbits_of_the_replication_from_half_on(n, release):
    """A second code with other unknowns, from ϖ = 0.5 on and without damping."""
    ratios = np.array([0.5, 0.8, 1.0, 4.0, 30.0])
    for r, share in ((1.0, 0.7), (0.85, 1.1), (0.4, 1.05)):
        amplitude = np.hypot(n * np.pi * (1 - r) / (1 + r), 0.6) * share
        y = upper_orbits(n, r, amplitude, ratios, release)[:, 0]
        zeta = damping_ratio(r, release)
        contact = Contact(ratios, zeta, release)
        family = Family(n, contact)
        seen = np.isfinite(y[0]) & (family.clearance(y) > 0)
        quantities = {
            name: np.broadcast_to(v, 5) for name, v in family.observables(y, OBSERVABLES).items()
        }
        for i in np.flatnonzero(seen):
            ball = SpringDamper(ratios[i], damping_ratio=zeta, release=release)
            every = orbits(ball, amplitude=amplitude, periods=n)
            near = [
                periodic_orbit
                for periodic_orbit in every
                if _same_phase(periodic_orbit.phase, quantities["phase"][i])
            ]
            assert len(near) == 1, (r, ratios[i])
            for name in ("impact_velocity", "bounce_velocity", "contact_duration"):
                assert getattr(near[0], name) == pytest.approx(quantities[name][i], abs=1e-10)
            assert near[0].max_height == pytest.approx(quantities["max_height"][i], abs=1e-10)
            assert near[0].stable == quantities["stable"][i]


def _same_phase(one, other):
    return abs(np.exp(1j * one) - np.exp(1j * other)) < 1e-9


@cache
def several_orbits():
    """Orbits of each model that is simulated, with one, two and three impacts."""
    (doubled,) = orbits(Rigid(0.5), impacts=2, periods=2, amplitude=1.6)
    return [
        orbit(Rigid(0.5), amplitude=1.3),
        doubled,
        *orbits(Rigid(0.5), impacts=3, periods=3, amplitude=1.6),
        orbit(SpringDamper(10.0, restitution=0.85), amplitude=1.0, n=2),
        orbit(SpringDamper(3.0, damping_ratio=0.2), amplitude=1.5),
        orbit(SpringDamper(4.0, restitution=0.7, release="force"), amplitude=1.0),
        *orbits(SpringDamper(2.0, restitution=0.85), amplitude=0.9),
        *orbits(SpringDamper(20.0, restitution=0.5), impacts=2, periods=2, amplitude=1.7)[:1],
        orbit(tsuji(restitution=0.85, duration=0.3, speed=3.4), amplitude=1.0),
        orbit(kuwabara_kono(restitution=0.7, duration=0.4, speed=3.7), amplitude=1.0),
        orbit(hunt_crossley(restitution=0.8, duration=0.2, speed=3.5), amplitude=1.2),
    ]


def test_an_integrated_ball_follows_the_orbits_and_their_derivatives():
    """A period by an integrator leads back, and differences of it are the monodromy matrix."""
    for periodic_orbit in several_orbits():
        start = np.array([periodic_orbit.times[0], periodic_orbit.speeds[0]])
        end, highest = around(periodic_orbit)
        stretch = 1 + np.abs(periodic_orbit.multipliers).max()
        assert np.abs(end - start).max() < INTEGRATED * stretch
        # Heights are sampled 20001 times in a contact.
        assert periodic_orbit.max_height == pytest.approx(highest, abs=1e-6)
        h = 1e-4
        columns = []
        for shift in np.eye(2) * h:
            columns.append(
                (around(periodic_orbit, shift)[0] - around(periodic_orbit, -shift)[0]) / (2 * h)
            )
        by_speed = np.diag([1, -1])
        numeric = by_speed @ np.array(columns).T @ by_speed
        # The differences err by h² times third derivatives, which are larger for unstable orbits.
        assert np.abs(numeric - periodic_orbit.monodromy).max() < 1e-5 * stretch**3
        assert periodic_orbit.admissible


def test_a_contact_may_resume_after_a_release_by_the_force():
    """The second impact starts below the level of the table, where the force is zero again."""
    ball = SpringDamper(11.27338, damping_ratio=0.3060670, release="force")
    equations = OrbitEquations(ball, 2, 1)
    first = Balls(ball, np.array([1.20411]), np.zeros(1), np.array([0.5]), np.array([3.0]))
    record, _, _ = bounce(first, 400)
    turns, phase, u, T, *_ = record[-2:, :, 0].T
    z = np.append(np.stack([2 * np.pi * (turns - turns[0]) + phase, u, T], axis=-1), 1.20411)
    solution = newton(equations, z[np.newaxis])
    assert solution.converged[0] and np.abs(solution.z[0] - z).max() < 1e-6
    periodic_orbit = PeriodicOrbit(equations, solution.z[0])
    assert (
        periodic_orbit.speeds.min() < -0.01 and periodic_orbit.stable and periodic_orbit.admissible
    )
    slow = int(np.argmin(periodic_orbit.speeds))
    end, gap, speed, _ = contact(
        ball, periodic_orbit.amplitude, periodic_orbit.times[slow], periodic_orbit.speeds[slow]
    )
    duration = end - periodic_orbit.times[slow]
    assert duration == pytest.approx(periodic_orbit.contact_duration[slow], abs=INTEGRATED)
    assert speed == pytest.approx(periodic_orbit.relative_bounce_velocity[slow], abs=INTEGRATED)
    assert gap == pytest.approx(-ball.kappa * speed, abs=INTEGRATED)


def test_a_table_may_lift_a_ball_higher_in_contact_than_it_flies():
    ball = SpringDamper(1.94317663, damping_ratio=0.60729752)
    periodic_orbit = orbit(ball, amplitude=0.96596752)
    assert periodic_orbit.stable and periodic_orbit.admissible
    assert periodic_orbit.max_height == pytest.approx(0.9157, abs=5e-5)
    assert periodic_orbit.max_height == pytest.approx(around(periodic_orbit)[1], abs=1e-6)


def test_multipliers_are_those_of_the_monodromy_matrix():
    for periodic_orbit in several_orbits():
        expected = np.linalg.eigvals(periodic_orbit.monodromy)
        expected = expected[np.argsort(-np.abs(expected))]
        ours = periodic_orbit.multipliers
        if abs(ours[0].imag) > 0:
            assert np.abs(ours.imag).max() == pytest.approx(np.abs(expected.imag).max(), abs=1e-9)
        assert ours.prod() == pytest.approx(expected.prod(), abs=1e-9)
        assert ours.sum() == pytest.approx(expected.sum(), abs=1e-9)


def test_a_compliant_contact_has_three_orbits():
    """The third one stays on the table for longer than one of its oscillations."""
    periodic_orbits = orbits(SpringDamper(2.0, restitution=0.85), amplitude=0.9)
    durations = [
        (round(periodic_orbit.contact_duration, 4), periodic_orbit.stable)
        for periodic_orbit in periodic_orbits
    ]
    assert durations == [(1.6018, True), (2.2489, False), (5.1824, True)]


@pytest.mark.parametrize(
    ("ball", "amplitude", "n"),
    [
        (SpringDamper(18.2, restitution=0.87), 1.69, 1),
        (SpringDamper(2.3, restitution=0.96, release="force"), 1.0, 2),
        (SpringDamper(0.61, damping_ratio=0.0), 2.0, 1),
        (Corrected(SpringDamper(8.0, restitution=0.6)), 2.0, 2),
        (Rigid(lambda u: 0.9 / (1 + 0.05 * u)), 1.9, 1),
    ],
)
def test_the_list_of_orbits_with_one_impact_is_complete(ball, amplitude, n):
    """Newton's method finds nothing else from 5,000 random starts."""
    listed = orbits(ball, amplitude=amplitude, periods=n)
    assert listed
    equations = OrbitEquations(ball, 1, n)
    random = np.random.default_rng(1)
    size = 5000
    columns = [random.uniform(0, 2 * np.pi, size), random.uniform(0, 2.2 * np.pi * n, size)]
    if ball.has_duration:
        columns.append(random.uniform(0, 2 * np.pi * n * ball.frequency_ratio, size))
    z = np.stack([*columns, np.full(size, amplitude)], axis=-1)
    solution = newton(equations, z, iterations=15)
    z = solution.z[solution.converged]
    z = z[(z[:, 1:-1] > 0).all(axis=1) & (np.abs(z[:, 0]) < 1e3)]
    z = z[np.unique(z.round(6), axis=0, return_index=True)[1]]
    z = z[equations.admissible(z)]
    distance = [
        np.abs(np.exp(1j * z[:, 0]) - np.exp(1j * periodic_orbit.phase))
        for periodic_orbit in listed
    ]
    distance = np.array(distance) + [
        np.abs(z[:, 1] - periodic_orbit.speeds[0]) for periodic_orbit in listed
    ]
    assert len(z)
    assert distance.min(axis=0).max() < 1e-6


@pytest.mark.parametrize(("impacts", "periods"), [(1, 1), (2, 1), (3, 1)])
@pytest.mark.parametrize("ball", [Rigid(0.5), SpringDamper(20.0, 0.5)])
def test_where_there_are_no_orbits_the_list_is_empty(ball, impacts, periods):
    """Below the saddle-node at Λ = π/3, the ball comes to rest on the table."""
    assert orbits(ball, impacts=impacts, periods=periods, amplitude=0.5) == []


@pytest.mark.parametrize("impacts", [2, 3])
def test_orbits_of_a_shorter_period_are_none_of_a_longer_one(impacts):
    """At Λ = 1.2 the 1-T orbit, which a search of 2-T orbits finds, has not doubled yet."""
    assert orbits(Rigid(0.5), impacts=impacts, periods=impacts, amplitude=1.2) == []


def test_where_a_contact_law_has_no_orbit_the_list_is_empty():
    assert orbits(tsuji(stiffness=3.0, damping=1.5), amplitude=0.3) == []


def test_orbits_with_several_impacts_are_found_by_their_number():
    periodic_orbits = orbits(Rigid(0.5), impacts=3, periods=3, amplitude=1.6)
    heights = [
        (round(periodic_orbit.max_height, 3), periodic_orbit.stable)
        for periodic_orbit in periodic_orbits
    ]
    assert heights == [(8.209, True), (8.007, False)]


def test_rows_have_an_orbit_or_a_reason_each():
    """At an amplitude below the saddle-node there is the reason in place of an orbit."""
    answers = orbit(Rigid([0.85, 0.85, 0.5]), amplitude=[0.1, 0.9, 1.3], n=[1, 2, 1])
    assert isinstance(answers[0], OrbitNotFound)
    for periodic_orbit, r, amplitude, n in ((answers[1], 0.85, 0.9, 2), (answers[2], 0.5, 1.3, 1)):
        alone = orbit(Rigid(r), amplitude=amplitude, n=n)
        assert np.abs(periodic_orbit.z - alone.z).max() < ROUNDED
        assert (
            periodic_orbit.periods,
            periodic_orbit.amplitude,
            periodic_orbit.ball.restitution,
        ) == (n, amplitude, r)


def test_a_reason_tells_two_amplitudes_apart():
    with pytest.raises(OrbitNotFound) as raised:
        orbit(Rigid(0.5), amplitude=1.047197)
    text = str(raised.value)
    assert "\n" not in text
    assert "Λ = 1.047197 " in text and text.endswith("below the saddle-node at Λ = 1.047197551")


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: orbit(Rigid(0.5), amplitude=-1), "amplitude = -1: must be in (0, ∞)"),
        (lambda: orbit(Rigid(0.5), amplitude="1.0"), "amplitude = '1.0': must be a number or"),
        (lambda: orbits(Rigid(0.5), amplitude=[1, 2]), "amplitude = [1, 2]: must be one number"),
        (lambda: orbits(Rigid(0.5), amplitude=1, impacts=0), "impacts = 0: must be a whole number"),
        (lambda: orbits(Rigid(0.5), amplitude=1, periods=2.5), "periods = 2.5: must be a whole"),
        (
            lambda: orbit(Rigid([0.5, 0.6]), amplitude=[1, 2, 3]),
            "restitution has (2,), amplitude has (3,)",
        ),
        (lambda: orbit(0.7, amplitude=1.0), "ball = 0.7: must be a ball, such as Rigid(0.7)"),
        (lambda: orbits(0.7, amplitude=1.0), "ball = 0.7: must be a ball, such as Rigid(0.7)"),
        (lambda: orbits(Rigid([0.5, 0.6]), amplitude=1.0), "must be one ball"),
        (lambda: limits(Rigid(0.5), n=0), "n = 0: must be in [1, 1000]"),
        (lambda: limits(Rigid(0.5), n=1.5), "n = 1.5: must be a whole number"),
        (lambda: orbit(Rigid(0.5), amplitude=1, n=0), "n = 0: must be in [1, 1000]"),
        (lambda: orbit(Rigid(0.5), amplitude=1, side="left"), "side = 'left': must be 'stable' or"),
    ],
)
def test_wrong_arguments_are_named_in_one_line(call, text):
    with pytest.raises(ValueError, match=r"must|shapes") as raised:
        call()
    assert text in str(raised.value) and "\n" not in str(raised.value)


@pytest.mark.parametrize("k", [1, 2, 16, 17, 37, 64])
@pytest.mark.parametrize(("q", "p"), [(2, 1), (3, 1), (3, 2)])
def test_the_elimination_by_pairs_solves_the_linear_equations(k, q, p):
    random = np.random.default_rng(k)
    derivatives = random.normal(size=(3, k, q, q + 2 + p))
    right, border = random.normal(size=(3, k, q, 2)), random.normal(size=(3, p, k * q + p))
    border_right = random.normal(size=(3, p, 2))
    solution = solve_bordered(derivatives, right, border, border_right)
    matrix = np.concatenate([dense(derivatives).reshape(3, k * q, -1), border], axis=1)
    expected = np.linalg.solve(matrix, np.concatenate([right.reshape(3, -1, 2), border_right], 1))
    size = np.linalg.cond(matrix).max() * np.abs(expected).max()
    assert np.abs(solution - expected).max() < 100 * np.finfo(float).eps * size


def test_nothing_warns_where_rows_have_no_solution():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        answers = orbit(SpringDamper([0.7, 30.0], restitution=0.5), amplitude=[0.01, 1.4])
    assert isinstance(answers[0], OrbitNotFound) and answers[1].stable


def test_the_search_with_a_contact_law_soon_finds_that_there_is_no_orbit(monkeypatch):
    """Balls that lie on the table, and impacts that have become long or fast, are not followed.

    The searches took 482 and 526 panels, and the limit leaves them twice as many.
    """
    ball = hunt_crossley(1000.0, 0.08)
    panels = []

    def counted(*given, **more):
        panels.append(1)
        assert len(panels) < 2000
        return solve_panel(*given, **more)

    monkeypatch.setattr(root_time, "solve_panel", counted)
    with pytest.raises(OrbitNotFound, match=r"below the saddle-node at Λ = 0\.253184639"):
        orbit(ball, amplitude=0.1)
    periodic_orbits = orbits(ball, amplitude=1.2)
    assert [
        (periodic_orbit.stable, periodic_orbit.admissible) for periodic_orbit in periodic_orbits
    ] == [(False, True), (False, True)]


def test_a_ball_without_restitution_leaves_where_the_table_falls_faster():
    lossy = orbit(Rigid(0.0), amplitude=3.3)
    assert lossy.admissible and lossy.amplitude * np.sin(lossy.phase) > 1
    assert not orbit(Rigid(0.0), amplitude=3.2).admissible


def test_rows_without_orbits_are_searched_together():
    """Each has what it has alone; a ball of a compliant contact has an orbit of another branch."""
    ratios = [1.5, 5.0, 5.0, 40.0]
    restitution = [0.9, 0.1, 0.6, 0.3]
    together = orbit(SpringDamper(ratios, restitution=restitution), amplitude=[1.6, 1.2, 0.3, 1.2])
    for row, answer in enumerate(together):
        ball = SpringDamper(ratios[row], restitution=restitution[row])
        try:
            alone = orbit(ball, amplitude=[1.6, 1.2, 0.3, 1.2][row])
        except OrbitNotFound as reason:
            assert str(answer) == str(reason)
        else:
            assert np.abs(answer.z - alone.z).max() < 1e-11
    missing = [isinstance(answer, OrbitNotFound) for answer in together]
    assert any(missing) and not all(missing)
    rigid = orbit(Rigid([0.1, 0.5, 0.3]), amplitude=1.2)
    assert [isinstance(answer, OrbitNotFound) for answer in rigid] == [True, False, True]


def test_a_contact_ends_where_its_root_time_repeats_it():
    """With m = 2, q oscillates about zero, and time runs backwards where q is negative."""
    law = hunt_crossley(400.0, 0.1)
    end = float(law.first_release(0.3, 2.0, 1.0))
    share = np.array([0.5, 1.0, 1.5, 10.0, 20.0])
    times = law.contact(0.3, 2.0, share * end, 1.0).duration
    assert times[0] == pytest.approx(times[2], abs=1e-7) and times[1] > times[0]
    assert np.isnan(times[3:]).all()


@pytest.mark.parametrize("beyond", [1e-6, 1e-8])
def test_orbits_next_to_a_saddle_node_are_listed_once(beyond):
    """Their phases are ±arccos(C/Λ), with C the Λ of the saddle-node, π/3 for r = 1/2."""
    periodic_orbits = orbits(Rigid(0.5), amplitude=np.pi / 3 * (1 + beyond))
    phase = np.arccos(1 / (1 + beyond))
    # The phase of a double root loses half of its digits.
    np.testing.assert_allclose(
        [periodic_orbit.phase for periodic_orbit in periodic_orbits], [phase, -phase], atol=1e-8
    )


def test_orbits_on_two_tones_return():
    """All four, by an integrator."""
    table = Table([(2, 0.25, 0.0), (3, 0.09, 0.4)])
    periodic_orbits = orbits(hunt_crossley(5e3, 0.05), amplitude=2.2, table=table)
    assert len(periodic_orbits) == 4
    for periodic_orbit in periodic_orbits:
        after, _ = around(periodic_orbit)
        np.testing.assert_allclose(
            after, [periodic_orbit.times[0], periodic_orbit.speeds[0]], atol=1e-8
        )


def test_a_search_ends_after_its_evaluations():
    tried = "tried: orbits near those of instantaneous impacts, motions from 3072 first impacts"
    text = f"orbit: no answer after 1,000 evaluations; {tried}; give more evaluations"
    with pytest.raises(effort.SearchEnded, match=f"^{text}$"):
        orbit(hunt_crossley(1000.0, 0.3), amplitude=0.2, evaluations=1000)


def test_searches_report_their_progress(monkeypatch):
    monkeypatch.setattr(effort, "EVERY", 0.0)
    told = []
    limits(Rigid(0.5), progress=told.append)
    lyapunov(Rigid(0.7), amplitude=1.345, phase=1.0, neighbours=1, progress=told.append)
    steps = [line.partition(",")[0] for line in told]
    assert {"limits: the branches of these orbits", "lyapunov: their neighbours"} <= {*steps}


@pytest.mark.parametrize("ball", [SpringDamper(20.0, damping_ratio=1.2), tsuji(1e3, 2.5)], ids=repr)
def test_a_contact_that_does_not_end_is_named_before_a_search(ball, monkeypatch):
    monkeypatch.setattr(OrbitEquations, "linearized", None)
    asked = [contact_values, exact_errors, law_errors, law_thresholds, error_thresholds]
    given = {call: {"amplitude": 1.0} for call in asked} | {free_impact: {}, Corrected: {}}
    for call, arguments in given.items():
        with pytest.raises(
            ValueError, match=re.escape(f"= {brief(ball)}: its free impacts do not")
        ):
            call(ball, **arguments)


def test_a_search_that_ended_is_an_entry_of_the_list():
    given = {"amplitude": [0.3, 0.9], "evaluations": 1000}
    ended, periodic_orbit = orbit(Rigid([0.3, 0.9]), **given)
    assert isinstance(ended, effort.SearchEnded) and periodic_orbit.stable
    assert follow([ended, periodic_orbit], to=1.5)[0] is ended
    with pytest.raises(effort.SearchEnded, match="no answer after 1,000 evaluations"):
        orbit(Rigid(0.3), amplitude=0.3, evaluations=1000)


def test_progress_is_asked_first_and_a_compilation_is_reported(monkeypatch):
    for search in (orbit, motion_of):
        with pytest.raises(ValueError, match="progress = True: must be a function of a line of te"):
            search(Rigid(0.5), amplitude=1.2, progress=True)
    told = []
    bounces.compile_loops.cache_clear()
    motion_of(Rigid(0.5), amplitude=1.2, progress=told.append)
    assert told[0].startswith("motion_of: numba compiles")
    monkeypatch.setattr(effort, "EVERY", 0.0)
    basins(hunt_crossley(1000.0, 0.3), amplitude=1.2, starts=4, impacts=25, progress=told.append)
    assert sum(line.startswith("basins: the balls") for line in told) > 24

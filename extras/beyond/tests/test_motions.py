"""The motions on which balls end, by orbits, finite differences and balls that are followed on."""

import numpy as np
import pytest
import xarray as xr

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.motions import bounces, long_term, simulation
from bouncing_ball_beyond.tables.table import PERIOD


def test_the_kinds_of_motions():
    ball = bb.Rigid(0.5)
    motions = bb.motion_of(ball, amplitude=[0.5, 1.2, 1.6, 2.5])
    assert motions.kind.values.tolist() == ["permanent contact", "periodic", "periodic", "locked"]
    assert motions.impacts.values[:3].tolist() == [0, 1, 2]
    assert motions.periods.values[:3].tolist() == [1, 1, 2]
    assert (motions.reason == "").all()


@pytest.mark.parametrize(
    ("call", "given"),
    [
        (bb.motion_of, {"phase": 0.0, "velocity": -np.pi}),
        (bb.lyapunov, {"phase": 0.0, "velocity": -np.pi}),
        (bb.basins, {"starts": 2}),
        (bb.orbit_diagram, {"starts": 2, "samples": 4}),
    ],
)
def test_a_motion_without_further_arguments_is_that_of_two_thousand_impacts(call, given):
    """A chaotic ball is followed to the last of them, so that one more would be seen."""
    chaotic = {"amplitude": [2.3] if call is bb.orbit_diagram else 2.3}
    counts = {name: count for name, count in given.items() if name in ("starts", "samples")}
    motions = call(bb.Rigid(0.85), **chaotic, **counts)
    assert motions.identical(call(bb.Rigid(0.85), **chaotic, **given, impacts=2000))


def test_two_impacts_in_two_periods_between_the_first_two_doublings():
    """At ϖ = 20 and r = 0.65 the 1-T orbit doubles its period at 1.23 and loses it before 1.35."""
    ball = bb.SpringDamper(20.0, restitution=0.65)
    motion = bb.motion_of(ball, amplitude=1.25)
    assert (motion.kind, motion.impacts, motion.periods) == ("periodic", 2, 2)
    assert bb.motion_of(ball, amplitude=1.2, phase=0.8).impacts == 1
    (orbit,) = (
        orbit for orbit in bb.orbits(ball, impacts=2, periods=2, amplitude=1.25) if orbit.stable
    )
    exponent = np.log(np.abs(orbit.multipliers).max()) / 2
    assert abs(motion.lyapunov_exponent - exponent) < 1e-6
    end = np.abs(np.angle(np.exp(1j * (orbit.phase - float(motion.end_phase)))))
    assert end.min() < 1e-6


def test_the_exponent_of_chaos_is_that_of_neighbours_that_separate():
    """The growth of a distance of 10⁻⁹ over 12 impacts, averaged over a chaotic motion."""
    ball = bb.SpringDamper(20.0, restitution=0.85)
    motion = bb.motion_of(ball, amplitude=2.0, impacts=20_000)
    assert motion.kind == "chaotic"
    _, balls = simulation.first_impacts(ball, 2.0, 0.0, -3.0, None)
    record, _, _ = bounces.bounce(balls, 20_000)
    tau, u = record[1000::4, 1, 0], record[1000::4, 2, 0]
    many = np.full(tau.size, 2.0)
    rates = []
    for impacts in (4, 12):
        ends = []
        for shift in (0.0, 1e-9):
            row = bounces.Balls(ball, many, 0 * tau, tau + 0.8 * shift, u + 0.6 * shift)
            ends.append(bounces.bounce(row, impacts)[2])
        angle = PERIOD * (ends[1].turns - ends[0].turns) + (ends[1].phase - ends[0].phase)
        distance = np.hypot(angle, ends[1].speed - ends[0].speed)
        rates.append(
            [np.log(distance).mean(), (PERIOD * ends[0].turns + ends[0].phase - tau).mean()]
        )
    # The direction of a deviation settles in the first impacts.
    growth, time = np.diff(rates, axis=0)[0]
    assert abs(PERIOD * growth / time / motion.lyapunov_exponent - 1) < 0.05


def test_the_error_of_an_exponent_covers_its_scatter():
    """Thirty pieces of one chaotic motion: their exponents scatter by their errors."""
    ball = bb.SpringDamper(20.0, restitution=0.85)
    whole = bb.motion_of(ball, amplitude=2.0, impacts=30_000)
    start = xr.DataArray(np.linspace(0.1, 3, 30), dims="start")
    pieces = bb.motion_of(ball, amplitude=2.0, phase=start, impacts=2000)
    chaotic = pieces.kind == "chaotic"
    assert chaotic.sum() > 20
    away = (pieces.lyapunov_exponent - whole.lyapunov_exponent) / pieces.lyapunov_error
    assert 0.3 < float(np.sqrt((away**2).where(chaotic).mean())) < 2.0
    assert whole.lyapunov_error < 0.5 * pieces.lyapunov_error.where(chaotic).mean()


def test_exponents_of_sections_with_a_known_scatter():
    """Independent growths have the standard error σ/√n; pairs of equal ones √2 times it."""
    rng = np.random.default_rng(5)
    growth = 1.0 + 0.3 * rng.standard_normal(1024)
    ones = np.ones(1024)
    rate, scatter, error = long_term.exponent(growth, ones, -ones)
    assert abs(scatter - 0.3 / np.sqrt(768)) < 0.05 * scatter
    assert abs(rate - 1) < 4 * scatter
    twice = np.repeat(growth[:512], 2)
    _, scatter, error = long_term.exponent(twice, ones, -ones)
    assert error > 1.2 * scatter
    assert np.isnan(long_term.exponent(growth, ones, -1e-3 * ones)[2])
    assert long_term.exponent(growth[:1], ones[:1], -ones[:1])[1] == np.inf


@pytest.mark.parametrize(
    "ball",
    [
        bb.Rigid(0.6),
        bb.Rigid(lambda u: 0.8 - 0.05 * u),
        bb.SpringDamper(7.0, restitution=0.6),
        bb.SpringDamper(7.0, restitution=0.6, release="force"),
        bb.SpringDamper(1.01, damping_ratio=0.02),
        bb.tsuji(stiffness=500.0, damping=0.3),
    ],
)
def test_tangent_maps_are_differences_of_simulated_impacts(ball):
    _, balls = simulation.first_impacts(ball, [1.2, 2.5], 1.0, -3.0, None)
    record, _, _ = bounces.bounce(balls, 4)
    maps = long_term.tangent_maps(balls, record, long_term.lift_offs(balls, record))
    step = 1e-6
    for j, (angle, speed) in enumerate(((step, 0.0), (0.0, step))):
        for i in range(4):
            ends = []
            for sign in (1, -1):
                state = record[i, 1] + sign * angle, record[i, 2] + sign * speed
                start = bounces.Balls(ball, balls.amplitude, np.zeros(2), *state)
                after = bounces.bounce(start, 1)[2]
                ends.append(np.array([PERIOD * after.turns + after.phase, after.speed]))
            slope = (ends[0] - ends[1]) / (2 * step)
            assert np.abs(slope - maps[:, j, i]).max() < 1e-6 * (1 + np.abs(slope).max())


def test_products_of_maps():
    rng = np.random.default_rng(1)
    maps = rng.standard_normal((2, 2, 13, 3))
    products, logarithms = long_term.running_products(maps)
    for ball in range(3):
        whole = np.eye(2)
        for i in range(13):
            whole = maps[:, :, i, ball] @ whole
            scaled = products[:, :, i, ball] * np.exp(logarithms[i, ball])
            assert np.abs(scaled - whole).max() < 1e-12 * np.abs(whole).max()
        assert np.allclose(long_term.product(maps)[..., ball], whole, rtol=1e-12, atol=1e-12)


def test_a_locked_ball_repeats_from_lift_off_to_lift_off():
    """Followed on, the ball sticks again after as many impacts and periods as were found."""
    ball = bb.Rigid(0.6)
    motion = bb.motion_of(ball, amplitude=3.0)
    assert (motion.kind, motion.lyapunov_exponent) == ("locked", -np.inf)
    impacts = bb.simulate(ball, amplitude=3.0, impacts=int(motion.followed) + 200)
    (rests,) = (impacts.contact_duration.values > 0).nonzero()
    assert np.diff(rests)[1:].tolist() == [int(motion.impacts)] * (rests.size - 2)
    time = (impacts.time + impacts.contact_duration).values[rests]
    assert np.abs(np.diff(time)[1:] - PERIOD * int(motion.periods)).max() < 1e-9


def test_a_compliant_contact_that_lasts_longer_than_two_free_ones_is_locked():
    ball = bb.SpringDamper(2.0, restitution=0.85)
    last = max(
        bb.orbits(ball, impacts=1, periods=1, amplitude=0.9), key=lambda o: o.contact_duration
    )
    start = {"phase": last.phase, "velocity": last.impact_velocity}
    motion = bb.motion_of(ball, amplitude=0.9, **start)
    assert (motion.kind, motion.periods, motion.impacts) == ("locked", 1, 1)


def test_a_contact_that_no_free_impact_leaves_does_not_stick():
    ball = bb.SpringDamper(20.0, damping_ratio=1.2)
    one = bb.orbit(ball, amplitude=3.5)
    assert one.stable and one.admissible and one.contact_duration < 0.5
    motion = bb.motion_of(ball, amplitude=3.5, phase=one.phase, velocity=one.impact_velocity)
    assert (motion.kind, motion.periods, motion.impacts) == ("periodic", 1, 1)


def test_balls_with_a_contact_and_with_instants_lock_after_other_periods():
    start = {"amplitude": 3.0, "phase": -1.5, "velocity": 0.0}
    contact = bb.motion_of(bb.SpringDamper(80.0, restitution=0.6), **start)
    instants = bb.motion_of(bb.Rigid(0.6), **start)
    assert (contact.periods, instants.periods) == (8, 13)


def test_what_is_not_known_has_a_reason():
    # Near the stable orbit of a nearly elastic ball motions are regular and decay slowly.
    one = bb.orbit(bb.Rigid(0.9999), amplitude=0.5)
    beside = {"phase": [one.phase, one.phase + 0.1], "velocity": one.impact_velocity}
    slow = bb.motion_of(one.ball, amplitude=0.5, impacts=200, **beside)
    assert (slow.kind == "undecided").all()
    assert slow.reason.values.tolist() == [long_term.MARGINAL, long_term.LITTLE_LOSS]
    # Rounding decides for which Λ the period of a locked motion is lost.
    locked = bb.motion_of(bb.Rigid(0.5), amplitude=np.linspace(4.9, 5.1, 20))
    assert (locked.kind == "locked").all()
    lost = locked.reason == long_term.LOST_TO_ROUNDING
    assert lost.any() and np.array_equal(lost, locked.impacts == 0)


def test_a_neighbour_that_rests_once_shows_a_transient():
    """A ball with r = 0.9 rests about once in three thousand impacts, and then repeats itself."""
    motion = bb.lyapunov(bb.Rigid(0.9), amplitude=1.25, phase=1.0)
    assert motion.kind in ("undecided", "locked")


def test_chaos_that_ends_is_a_transient():
    """A ball that sticks once in some thousand impacts looks chaotic in two thousand."""
    motion = bb.lyapunov(bb.Rigid(0.7), amplitude=1.85, phase=1.0, impacts=400)
    assert motion.kind in ("undecided", "locked")
    if motion.kind == "undecided":
        assert motion.reason == long_term.TRANSIENT
        assert np.isnan(motion.lyapunov_exponent)
    above = bb.lyapunov(bb.Rigid(0.7), amplitude=1.345, phase=1.0)
    assert above.kind == "chaotic"
    assert 0.13 < above.lyapunov_exponent < 0.16
    assert above.lyapunov_error < 0.02


def test_exponents_without_neighbours_are_those_of_the_ball_alone():
    """Then a transient is not told from chaos, and nothing else changes."""
    given = {"amplitude": [1.2, 1.85], "phase": 1.0, "impacts": 400}
    motions = bb.lyapunov(bb.Rigid(0.7), neighbours=0, **given)
    assert motions.identical(bb.motion_of(bb.Rigid(0.7), **given))
    assert motions.kind[1] == "chaotic" and np.isfinite(motions.lyapunov_exponent[1])
    with pytest.raises(ValueError, match=r"neighbours = -1: must be a whole number from 0"):
        bb.lyapunov(bb.Rigid(0.7), neighbours=-1, **given)


@pytest.mark.parametrize("ball", [bb.Rigid(0.65), bb.SpringDamper(10.0, restitution=0.65)])
def test_basins_are_the_motions_of_balls_one_by_one(ball):
    basins = bb.basins(ball, amplitude=1.1, starts=7)
    assert abs(float(basins.share.sum()) - 1) < 1e-12
    # Each start is in the middle of a cell, and all cells are of the same size.
    middle = (np.arange(7) + 0.5) / 7
    assert np.allclose(basins.phase, 2 * np.pi * middle - np.pi, rtol=1e-14)
    assert np.allclose(basins.speed, middle * 1.1 * 1.65 / 0.35, rtol=1e-14)
    for i in range(7):
        for j in range(0, 7, 3):
            u, tau = float(basins.speed[i]), float(basins.phase[j])
            alone = bb.motion_of(ball, amplitude=1.1, phase=tau, relative_velocity=-u)
            motion = basins.isel(motion=int(basins.destination[i, j]))
            assert (motion.kind, motion.impacts) == (alone.kind, alone.impacts)
    counts = np.bincount(basins.destination.values.ravel()) / 49
    assert np.allclose(counts, basins.share)


def test_two_orbits_with_as_many_impacts_and_periods_are_two_motions():
    """A third harmonic splits the doubled orbit: there are two stable ones.

    All balls that rest leave in one state, after which rounding errors grow by more than their
    inverse: where they end is left out, because the last digits decide it.
    """
    ball = bb.Rigid(0.6)
    table = bb.Table([(1, 1.0, 0.0), (3, 0.05, 0.7)])
    basins = bb.basins(ball, amplitude=1.555, starts=8, table=table)
    periodic = np.flatnonzero(basins.kind == "periodic")
    settled = np.isin(basins.destination, periodic)
    assert len(periodic) == 2 and settled.mean() > 0.5
    orbits = bb.orbits(ball, impacts=2, periods=2, amplitude=1.555, table=table)
    stable = sorted((orbit for orbit in orbits if orbit.stable), key=lambda orbit: min(orbit.phase))
    fastest = [np.argmin(orbit.relative_impact_velocity) for orbit in stable]
    for i, orbit, k in zip(range(2), stable, fastest, strict=True):
        motion = basins.isel(motion=periodic[i])
        assert abs(motion.end_phase - orbit.phase[k]) < 1e-6
        assert abs(motion.end_velocity - orbit.impact_velocity[k]) < 1e-6
    states = bb.motion_of(
        ball, amplitude=1.555, phase=basins.phase, relative_velocity=-basins.speed, table=table
    ).transpose(*basins.destination.dims)
    ends = states.end_phase.values
    away = [np.min([np.abs(ends - p) for p in orbit.phase], axis=0) for orbit in stable]
    assert np.array_equal(
        basins.destination.values[settled], periodic[np.argmin(away, axis=0)][settled]
    )
    assert np.min(away, axis=0)[settled].max() < 1e-6
    assert np.allclose(basins.share, np.bincount(basins.destination.values.ravel()) / 64)


def test_no_ball_leaves_the_speeds_of_a_basin():
    """Above the fastest speed of :func:`fastest` every impact slows a ball."""
    fast = long_term.fastest(bb.Rigid(0.5), 2.0)
    assert fast == 6.0
    impacts = bb.simulate(bb.Rigid(0.5), amplitude=2.0, velocity=-5.0, phase=0.1, impacts=2000)
    assert impacts.bounce_velocity.max() < fast


def test_an_orbit_diagram_doubles_where_the_orbit_does():
    ball = bb.Rigid(0.5)
    doubling = 1.526824
    diagram = bb.orbit_diagram(ball, amplitude=doubling + np.array([-0.05, 0.05]), impacts=1000)
    assert diagram.impact_phase.dims == ("amplitude", "start", "impact")
    one, two = (diagram.isel(amplitude=i) for i in (0, 1))
    orbit = bb.orbit(ball, amplitude=doubling - 0.05)
    on_orbit = (one.impacts == 1) & (one.periods == 1)
    assert on_orbit.any()
    assert np.abs(one.impact_phase.where(on_orbit) - orbit.phase).max() < 1e-6
    assert (two.impacts == 2).any() and not ((two.impacts == 1) & (two.periods == 1)).any()
    # Balls that start from the ends at the other amplitude follow the orbit across the doubling.
    assert (two.impacts.isel(start=slice(6, 12)) == 2).sum() >= (one.impacts[:6] == 1).sum()
    along = bb.orbit_diagram(bb.Rigid([0.5, 0.6]), amplitude=1.2, starts=2, samples=3)
    assert along.impact_speed.dims == ("restitution", "start", "impact")


def test_basins_keep_the_number_of_impacts_and_refuse_arrays():
    assert bb.basins(bb.Rigid(0.5), amplitude=1.2, starts=4, impacts=500).attrs["impacts"] == 500
    for ball, amplitude in ((bb.Rigid(0.5), [1.0, 1.2]), (bb.Rigid([0.5, 0.6]), 1.2)):
        with pytest.raises(ValueError, match=r"must be one (number|ball)"):
            bb.basins(ball, amplitude=amplitude)
    with pytest.raises(ValueError, match=r"^ball = 0\.7: must be a ball, such as Rigid\(0\.7\)$"):
        bb.basins(0.7, amplitude=1.2)
    with pytest.raises(ValueError, match=r"^relative_velocity_max = -1: must be in \(0, ∞\)$"):
        bb.basins(bb.Rigid(0.5), amplitude=1.2, relative_velocity_max=-1)


def test_a_summary_of_many_impacts_needs_no_history():
    """The greatest number of impacts that are kept at a time does not grow with those followed."""
    most = []
    bounce = long_term.bounce

    def watched(balls, impacts, *effort):
        most.append(impacts * balls.phase.size)
        return bounce(balls, impacts, *effort)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(long_term, "bounce", watched)
        motion = bb.motion_of(
            bb.SpringDamper(20.0, restitution=0.9), amplitude=2.85, impacts=60_000
        )
    assert motion.followed >= 60_000
    assert max(most) <= long_term.IMPACTS_AT_ONCE


@pytest.mark.parametrize(("distance", "repeats"), [(0.5e-7, True), (2e-7, False)])
def test_a_slowly_converging_speed_repeats_only_near_its_fixed_point(distance, repeats):
    """With multipliers 0.99 and 0.5, the change per impact is 0.01 of the distance to the orbit."""
    impacts = 50
    speed = 1 + distance * 0.99 ** np.arange(-impacts + 1.0, 2.0)
    record = np.full((impacts, 8, 1), np.nan)
    record[:, 0, 0] = np.arange(impacts)
    record[:, 1, 0] = 1.0
    record[:, 2, 0] = speed[:-1]
    one = np.ones(1)
    balls = bounces.Balls(bb.Rigid(0.5), 0 * one, 0 * one, one, speed[:1])
    after = bounces.Balls(bb.Rigid(0.5), 0 * one, impacts * one, one, speed[-1:])
    maps = np.zeros((2, 2, impacts, 1))
    maps[0, 0], maps[1, 1] = 0.5, 0.99
    recurrence = long_term.recurrence(balls, record, after, maps)
    assert recurrence["repeats"][0] == repeats
    assert recurrence["impacts"][0] == recurrence["periods"][0] == 1
    assert recurrence["radius"][0] == pytest.approx(0.99)

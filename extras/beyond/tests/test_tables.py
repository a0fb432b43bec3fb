"""Tables of other waveforms against differences, the sine, and an integration of their motions."""

import re

import numpy as np
import pytest
from integrated import around, leg

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.contacts.balls import H
from bouncing_ball_beyond.motions.bounces import until_lift_off
from bouncing_ball_beyond.tables.table import SINE, Table

TABLES = {
    "three harmonics": Table([(1, 1.0, 0.0), (2, 0.17, 0.8), (3, 0.05, -1.1)]),
    "skewed": Table([(1, 1.0, 0.0), (2, 0.25, 2.5)]),
    "two maxima": Table([(1, 1.0, 0.0), (3, 0.4, 0.7)]),
}
AS_SINE = Table([(1, 1.0, 0.0)])
"""A sine that is not the default, whose motions are found by the general functions."""

BALLS = {
    "restitution": bb.Rigid(0.8),
    "contact": bb.SpringDamper(15.0, 0.8),
    "force release": bb.SpringDamper(15.0, 0.8, release="force"),
    "overdamped": bb.SpringDamper(9.0, damping_ratio=1.1),
    "resonant": bb.SpringDamper(2.0, damping_ratio=0.02),
}


# The waveform


@pytest.mark.parametrize("name", TABLES)
def test_derivatives_differences_and_bounds(name):
    table = TABLES[name]
    tau = np.linspace(-4, 9, 2001)
    for order in range(5):
        by_step = table(tau + 1j * H, order).imag / H
        np.testing.assert_allclose(table(tau, order + 1), by_step, atol=1e-13)
        assert np.abs(table(tau, order)).max() <= table.bounds[order]
    for time in (1e-9, 1e-3, 2.0):
        height, rate = table.displacement(tau, time)
        # Short differences are those of the Taylor series.
        expected = time * table(tau, 1) + time**2 / 2 * table(tau, 2)
        if time < 1:
            rest = table.bounds[3] * time**3 / 6 + 2e-15 * table.bounds[1] * time
            np.testing.assert_allclose(height, expected, 0, rest)
        # Of the harmonics k, W(τ + t) has the rounding errors of kτ.
        rounding = 2e-15 * table.bounds[1], 2e-15 * table.bounds[2]
        np.testing.assert_allclose(height, table(tau + time) - table(tau), 0, rounding[0] * 9)
        np.testing.assert_allclose(rate, table(tau + time, 1) - table(tau, 1), 0, rounding[1] * 9)
    assert table.slope >= table(tau, 1).max()
    assert table.peaks[0] >= table(tau).max() and table.peaks[1] <= table(tau).min()
    assert table.lift >= -table(tau, 2).min()


def test_each_table_of_a_row_has_its_bounds():
    two = TABLES["two maxima"]
    sizes = np.array([0.1, 0.4])
    expected = np.transpose([two.at(harmonic_3=size).bounds for size in sizes])
    for row in (sizes, sizes[:, np.newaxis]):
        bounds = np.array(two.at(harmonic_3=row).bounds).reshape(6, 2)
        np.testing.assert_allclose(bounds, expected, 1e-14)


@pytest.mark.parametrize("name", TABLES)
def test_where_a_table_falls_as_fast_as_a_ball(name):
    table = TABLES[name]
    amplitude = np.array([0.5, 1.0, 1.7])
    levels = table.levels(amplitude)
    tau = np.linspace(0, 2 * np.pi, 100001)
    for phases, scale in zip(levels, amplitude, strict=True):
        phases = phases[np.isfinite(phases)]
        assert np.abs(1 + scale * table(phases, 2)).max(initial=0) < 1e-12
        changes = np.diff(np.sign(1 + scale * table(tau, 2))) != 0
        assert len(phases) == np.count_nonzero(changes)
    lies = tau[np.argmax(table(tau, 2))]
    wait, leaves = until_lift_off(table, lies, np.array(2.5))
    assert np.all(1 + 2.5 * table(np.linspace(lies, lies + wait - 1e-6, 1000), 2) > 0)
    assert 1 + 2.5 * table(leaves, 2) == pytest.approx(0, abs=1e-12)
    assert table(leaves, 3) < 0


def test_samples_give_the_table_and_those_of_an_acceleration_too():
    table = TABLES["three harmonics"]
    tau = 2 * np.pi * np.arange(40) / 40
    greatest = np.abs(table(np.linspace(0, 2 * np.pi, 1_000_001), 2)).max()
    for sampled_table in (
        Table.of_samples(3 * table(tau) + 7),
        Table.of_samples(5 * table(tau, 2) - 1, acceleration=True),
    ):
        np.testing.assert_allclose(greatest * sampled_table(tau, 1), table(tau, 1), atol=1e-11)
        assert np.abs(sampled_table(np.linspace(0, 7, 100_001), 2)).max() == pytest.approx(
            1, abs=1e-8
        )


@pytest.mark.parametrize(
    ("harmonics", "text"),
    [
        ([], "harmonics: at least one must have a size other than 0"),
        (3, "harmonics = 3: must be a list of"),
        ([(1, 1.0, 0.0), (1, 0.5, 0.2)], "harmonics: the order 1 occurs twice"),
        ([(1, 0.0, 0.0)], "harmonics: at least one must have a size other than 0"),
        ([(1.5, 1.0, 0.0)], "frequencies in a ratio of whole numbers have a common period"),
        ([(0, 1.0, 0.0)], "a whole number k from 1"),
        ([(1, np.nan, 0.0)], "a whole number k from 1"),
        ([1], "must be"),
    ],
)
def test_what_is_no_table_is_one_line(harmonics, text):
    with pytest.raises(ValueError, match=text) as raised:
        Table(harmonics)
    assert "\n" not in str(raised.value)
    with pytest.raises(ValueError, match="table = 'sine': must be a Table"):
        bb.orbit(bb.Rigid(0.5), amplitude=1.0, table="sine")


SINES = np.sin(2 * np.pi * np.arange(64) / 64)


@pytest.mark.parametrize(
    ("values", "others", "text"),
    [
        (np.r_[SINES, 0.0], {}, "harmonics above 16 have 93% of the acceleration"),
        (SINES + 1e-2 * (-1.0) ** np.arange(64) * SINES, {}, "harmonics above 15 have"),
        (np.sin(np.arange(200) * 10.4 * 2 * np.pi / 200), {}, "last sample do not join"),
        (np.sin(np.arange(900) * 10.4 / 140), {"acceleration": True}, "last sample do not join"),
        (SINES, {"harmonics": 0}, "harmonics: must be whole numbers from 1"),
        (SINES, {"harmonics": -3}, "harmonics: must be whole numbers from 1"),
        (SINES, {"harmonics": 2.5}, "harmonics: must be whole numbers from 1"),
        ("samples.csv", {}, "values: must be a row of finite numbers"),
        (np.ones(9), {}, "the table would be at rest"),
    ],
)
def test_samples_that_are_not_those_of_one_period_are_refused(values, others, text):
    with pytest.raises(ValueError, match=text) as raised:
        Table.of_samples(values, **others)
    assert "\n" not in str(raised.value)


def test_noisy_heights_give_their_table_with_as_many_harmonics_as_are_meant():
    table = Table([(1, 1.0, 0.0), (3, 0.05, 0.7)])
    noise = np.random.default_rng(1).normal(0, 0.002, 200)
    sampled_table = Table.of_samples(table(np.arange(200) * 2 * np.pi / 200) + noise, harmonics=5)
    node = bb.limits(bb.Rigid(0.6), table=sampled_table).saddle_node.amplitude * sampled_table.slope
    # By the closed form Λ max W′ = C, whatever the harmonics.
    assert node == pytest.approx(np.pi * 0.25, rel=1e-9)
    # A fit of 200 samples has a tenth of their noise; 2e-3 is that of a third harmonic times 9.
    assert table.acceleration * sampled_table.slope == pytest.approx(table.slope, abs=4e-3)


def test_a_record_of_any_length_gives_the_table_and_its_amplitude():
    """Also if the clock of the recorder is off."""
    table = Table([(1, 1.0, 0.4), (3, 0.05, 0.7)])
    time = np.sort(np.random.default_rng(2).uniform(0, 0.416, 900))
    signal = 9.81 + 0.9 * 9.80665 * table(2 * np.pi * 25 * time, 2)
    measured_table = Table.of_record(time, signal, frequency=25.2, harmonics=5)
    assert measured_table.amplitude == pytest.approx(0.9 * table.acceleration, rel=1e-9)
    assert measured_table.frequency == pytest.approx(25.0, rel=1e-9)
    assert measured_table.residual < 1e-9
    tau = np.linspace(0, 7, 50)
    np.testing.assert_allclose(
        measured_table.amplitude * measured_table.table(tau), 0.9 * table(tau), atol=1e-8
    )
    two = Table([(12, 0.01, 0.3), (17, 0.006, 1.0)])
    signal = 9.80665 * two(2 * np.pi * 8 * time, 2)
    measured_table = Table.of_record(time, signal, frequency=8.0, harmonics=[12, 17])
    assert measured_table.table.orders == (12, 17)
    assert measured_table.amplitude == pytest.approx(two.acceleration, rel=1e-9)


def test_a_drift_that_does_not_end_as_it_begins_is_no_tone():
    time = np.arange(0, 60, 1e-3)
    noise = np.random.default_rng(3).normal(0, 0.03, time.size)
    signal = 9.80665 * np.sin(2 * np.pi * 31.7 * time) + 0.5 * np.sin(0.19 * time) + noise
    measured_table = Table.of_record(time, signal, frequency=31.7, harmonics=1)
    assert abs(measured_table.amplitude - 1) < 3 * measured_table.amplitude_error


def made_record(generator, seconds, change=None):
    """A record with a clock that is off, noise, a drift and a gap, its Λ and its frequency."""
    frequency = generator.uniform(20, 40)
    true = frequency * (1 + generator.uniform(-0.01, 0.01))
    time = np.arange(0, seconds, 1 / 400)
    time = time[(time < 0.4 * seconds) | (time > 0.6 * seconds)]
    size = generator.uniform(5, 15)
    stretched = time if change != "frequency" else time * (1 + 1e-3 * time / seconds)
    signal = size * np.sin(2 * np.pi * true * stretched)
    if change == "tone":
        signal += 0.05 * size * np.sin(2 * np.pi * 1.4 * true * time)
    if change == "amplitude":
        signal *= 1 + 0.1 * time / seconds
    signal += 9.81 + 0.5 * time / seconds + generator.normal(0, 0.3, time.size)
    return {"time": time, "acceleration": signal, "frequency": frequency}, size / 9.80665, true


def test_measured_tables_are_right_within_their_errors():
    """In 95 of 100 records within twice the standard error: at least 32 of 40."""
    generator = np.random.default_rng(5)
    within = []
    for seconds in np.geomspace(1, 60, 40):
        record, amplitude, frequency = made_record(generator, seconds)
        measured_table = Table.of_record(**record, harmonics=2)
        off = [measured_table.amplitude - amplitude, measured_table.frequency - frequency]
        errors = np.array([measured_table.amplitude_error, measured_table.frequency_error])
        within.append(np.abs(off) < 2 * errors)
        assert measured_table.residual == pytest.approx(0.3, rel=0.25)
    assert np.sum(within, axis=0).min() >= 32


@pytest.mark.parametrize("change", ["tone", "frequency", "amplitude"])
def test_a_residual_that_noise_does_not_explain_is_refused(change):
    record, _, _ = made_record(np.random.default_rng(3), 20.0, change)
    with pytest.raises(ValueError, match="noise does not explain a tone of"):
        Table.of_record(**record, harmonics=2)


def test_a_jump_of_the_acceleration_is_named_with_its_factor():
    """Parabolas, whose acceleration is ±1: by hand the saddle-node is at Λ = 2C/π with r = 0.8."""
    tau = 2 * np.pi * np.arange(256) / 256
    heights = np.where(tau < np.pi, tau * (np.pi - tau), (tau - np.pi) * (tau - 2 * np.pi))
    with pytest.warns(UserWarning, match=r"Λ is here 1\.\d+ times the largest") as warned:
        table = Table.of_samples(heights)
    factor = float(re.search(r"here ([\d.]+) times", str(warned[0].message))[1])
    node = bb.limits(bb.Rigid(0.8), table=table).saddle_node.amplitude
    assert node / factor == pytest.approx(np.pi * (0.2 / 1.8) / (np.pi / 2), rel=0.02)


@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ({"time": [0.0, 1.0]}, "time, acceleration: have 2 and 64 samples"),
        ({"frequency": "25 Hz"}, "frequency = '25 Hz': must be a positive number"),
        ({"frequency": 0.5}, "samples of 0.492 periods are too few for 3 harmonics"),
        ({"harmonics": 40}, "are too few for 40 harmonics"),
        ({"frequency": 64.0}, "cannot distinguish all harmonics"),
        ({"harmonics": []}, "harmonics: is empty: give at least one order"),
        ({"harmonics": [5]}, "noise does not explain a tone of"),
        ({"acceleration": np.ones(64)}, "acceleration: is constant"),
    ],
)
def test_what_is_no_record_is_one_line(changed, text):
    given = {"time": np.arange(64) / 64, "acceleration": SINES, "frequency": 1.0, "harmonics": 3}
    with pytest.raises(ValueError, match=text) as raised:
        Table.of_record(**given | changed)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("changed", "text"),
    [
        ({"phase_3": np.linspace(0, 6, 5)}, "its phase_3 is an array, but must be a number"),
        ({"phase_3": np.nan}, "a whole number k from 1 and numbers a, p"),
        ({"harmonic_3": "x"}, "a whole number k from 1 and numbers a, p"),
        ({"harmonic_1": 0.0, "harmonic_3": 0.0}, "at least one must have a size other than 0"),
    ],
)
def test_a_changed_table_is_checked_where_it_is_used(changed, text):
    table = Table([(1, 1.0, 0.0), (3, 0.05, 0.7)]).at(**changed)
    ball = bb.Rigid(0.6)
    for call in (bb.orbit, bb.motion_of, bb.basins):
        with pytest.raises(ValueError, match=text) as raised:
            call(ball, amplitude=1.2, table=table)
        assert "\n" not in str(raised.value)


# Motions


@pytest.mark.parametrize("ball", BALLS)
def test_a_sum_of_one_harmonic_is_the_sine(ball):
    given = {"amplitude": 1.4, "phase": [0.3, -2.0, 2.4], "velocity": -5.0, "impacts": 12}
    sine = bb.simulate(BALLS[ball], **given)
    general = bb.simulate(BALLS[ball], **given, table=AS_SINE)
    for name in ("time", "relative_impact_velocity", "contact_duration"):
        np.testing.assert_allclose(sine[name], general[name], rtol=1e-9, atol=1e-10)


@pytest.mark.parametrize("ball", ["force release", "overdamped"])
@pytest.mark.parametrize("name", TABLES)
def test_a_simulated_ball_is_an_integrated_one(name, ball):
    """Impact by impact, each from the simulated one before it."""
    table = TABLES[name]
    impacts = bb.simulate(
        BALLS[ball], amplitude=0.9, phase=0.4, velocity=-4.0, impacts=8, table=table
    )
    phase = impacts.impact_phase.values
    u = -impacts.relative_impact_velocity.values
    times = impacts.time.values
    bounces = np.flatnonzero(
        np.isfinite(u[1:]) & (impacts.relative_bounce_velocity.values[:-1] > 0)
    )
    assert len(bounces) > 2
    for i in bounces:
        lands, closing, _ = leg(BALLS[ball], 0.9, phase[i], u[i], tuple(table.harmonics))
        assert lands - phase[i] == pytest.approx(times[i + 1] - times[i], abs=2e-10)
        assert closing == pytest.approx(u[i + 1], abs=2e-10)


def test_no_touch_is_missed():
    """Random short flights of three tables: no sample before a landing is below the table."""
    rng = np.random.default_rng(92)
    for table in TABLES.values():
        given = {"amplitude": 3.0, "phase": rng.uniform(-3, 3, 60), "impacts": 6, "table": table}
        impacts = bb.simulate(bb.Rigid(0.3), relative_velocity=-0.4, **given)
        start, flight, w = (
            impacts[name].values.ravel()
            for name in ("impact_phase", "flight_time", "relative_bounce_velocity")
        )
        good = np.isfinite(flight) & (w > 1e-3)
        start, flight, w = (quantity[good, np.newaxis] for quantity in (start, flight, w))
        t = flight * np.linspace(1e-3, 1 - 1e-3, 400)
        height, _ = table.displacement(start, t)
        gap = (w + 3.0 * table(start, 1) - t / 2) * t - 3.0 * height
        assert len(gap) > 100
        assert gap.min() > -1e-12


# Orbits


@pytest.mark.parametrize("ball", ["force release", "overdamped", "resonant"])
@pytest.mark.parametrize("name", TABLES)
def test_all_orbits_are_those_of_an_integrated_ball(name, ball):
    orbits = bb.orbits(BALLS[ball], amplitude=0.7, table=TABLES[name])
    assert orbits or ball in ("overdamped", "resonant")
    for orbit in orbits:
        end, highest = around(orbit)
        assert end == pytest.approx([orbit.times[0], orbit.speeds[0]], abs=1e-9)
        assert highest == pytest.approx(orbit.max_height, abs=1e-7)
        step = 1e-5
        moved = [[around(orbit, side * shift)[0] for side in (1, -1)] for shift in step * np.eye(2)]
        matrix = np.array([(up - down) / (2 * step) for up, down in moved]).T
        size = 1 + np.abs(matrix).max()
        assert np.trace(matrix) == pytest.approx(sum(orbit.multipliers).real, abs=1e-5 * size)


def test_a_table_with_two_maxima_has_more_than_two_orbits():
    table = TABLES["two maxima"]
    orbits = bb.orbits(bb.Rigid(0.9), amplitude=0.7, table=table)
    C = np.pi * 0.1 / 1.9
    tau = np.linspace(0, 2 * np.pi, 100001)
    crossings = np.count_nonzero(np.diff(np.sign(0.7 * table(tau, 1) - C)) != 0)
    assert crossings > 2
    slopes = [0.7 * table(orbit.phase, 1) for orbit in orbits]
    assert slopes == pytest.approx(len(orbits) * [C], abs=1e-12)
    assert 2 < len(orbits) <= crossings


@pytest.mark.parametrize(
    ("ball", "table", "doubling"),
    [
        (bb.Rigid(0.9), Table([(1, 1.0, 0.0), (3, 0.05, -1.1)]), 0.8581675),
        (bb.SpringDamper(100.0, 0.9), Table([(1, 1.0, 0.0), (3, 0.05, -1.1)]), 0.8589495),
        (bb.Rigid(0.9), TABLES["three harmonics"], 0.6463308),
        (bb.SpringDamper(100.0, 0.9), TABLES["three harmonics"], 0.6467971),
    ],
)
def test_limits_are_those_of_another_code(ball, table, doubling):
    """Numbers of a code from scratch, which follows single orbits."""
    limits = bb.limits(ball, table=table)
    assert limits.period_doubling.amplitude == pytest.approx(doubling, abs=1e-7)
    assert limits.period_doubling.multipliers.real.min() == pytest.approx(-1, abs=1e-9)
    fold = limits.saddle_node
    if not ball.has_duration:
        assert fold.amplitude == pytest.approx(np.pi * 0.1 / 1.9 / table.slope, abs=1e-12)
    near = bb.orbit(ball, amplitude=1.01 * fold.amplitude, table=table)
    assert near.stable and near.admissible


def test_the_doubling_of_the_restitution_model_is_its_closed_form():
    """1 + tr + det = 0 where -ΛW″ = 2(1 + r²)/(1 + r)², at ΛW′ = C."""
    for r in (0.5, 0.8):
        table = TABLES["skewed"]
        doubling = bb.limits(bb.Rigid(r), table=table).period_doubling
        rise = 2 * (1 + r * r) / (1 + r) ** 2
        assert -doubling.amplitude * table(doubling.phase, 2) == pytest.approx(rise, abs=1e-10)


def test_along_a_harmonic_and_its_phase_orbits_go_from_the_sine_to_other_tables():
    ball = bb.SpringDamper(20.0, 0.7)
    start = bb.orbit(ball, amplitude=0.9, table=Table([(1, 1.0, 0.0), (2, 0.0, 0.8)]))
    assert start.z == pytest.approx(bb.orbit(ball, amplitude=0.9).z, abs=1e-12)
    branch = bb.follow(start, along="harmonic_2", to=0.2)
    assert branch.end == "harmonic_2 = 0.2 is reached"
    there = bb.orbit(ball, amplitude=0.9, table=Table([(1, 1.0, 0.0), (2, 0.2, 0.8)]))
    assert branch.z[-1, :-1] == pytest.approx(there.z[:-1], abs=1e-11)
    turned = bb.follow(branch.orbits[-1], along="phase_2", to=2.5)
    there = bb.orbit(ball, amplitude=0.9, table=Table([(1, 1.0, 0.0), (2, 0.2, 2.5)]))
    assert turned.z[-1, :-1] == pytest.approx(there.z[:-1], abs=1e-10)
    # A phase of a whole turn changes nothing.
    back = bb.follow(turned.orbits[-1], along="phase_2", to=2.5 + 2 * np.pi)
    assert back.z[-1, :-1] == pytest.approx(there.z[:-1], abs=1e-10)


def test_a_curve_of_doublings_along_a_harmonic_is_made_of_limits():
    table = Table([(1, 1.0, 0.0), (2, 0.1, 0.8)])
    doubling = bb.limits(bb.Rigid(0.7), table=table).period_doubling
    ranges = {"amplitude": (0.3, 2.0), "harmonic_2": (-0.1, 0.2)}
    curve = bb.special_curve(doubling, along=("amplitude", "harmonic_2"), ranges=ranges)
    for orbit in curve.orbits[:: max(1, len(curve) // 4)]:
        limit = bb.limits(orbit.ball, table=orbit.table).period_doubling
        assert limit.amplitude == pytest.approx(orbit.amplitude, abs=1e-9)


def test_along_a_phase_one_turn_is_the_default():
    """Harmonics of any sign and phases of any value have a range around them."""
    ball = bb.Rigid(0.6)
    for p in (0.0, 0.7):
        table = Table([(1, 1.0, 0.0), (3, 0.01, p)])
        one = bb.orbit(ball, amplitude=1.1, table=table)
        turned = bb.follow(one, along="phase_3")
        assert turned.end == f"phase_3 = {p + 2 * np.pi:.10g} is reached"
        doubling = bb.limits(ball, table=table).period_doubling
        curve = bb.special_curve(doubling, along=("amplitude", "phase_3"), points=200)
        ends = np.sort(curve.z[[0, -1], -1])
        np.testing.assert_allclose(ends, [p - np.pi, p + np.pi], atol=1e-9)
        assert curve.z[0, -2] == pytest.approx(curve.z[-1, -2], rel=1e-9)
    with pytest.raises(ValueError, match=r"to: phase_3 = inf: must be in \(-∞, ∞\)"):
        bb.follow(one, along="phase_3", to=np.inf)
    negative = Table([(1, 1.0, 0.0), (3, -0.01, 0.0)])
    doubling = bb.limits(ball, table=negative).period_doubling
    curve = bb.special_curve(doubling, along=("amplitude", "harmonic_3"), points=3)
    assert len(curve.z) > 3


# Motions on which balls end


def test_a_locked_ball_leaves_at_a_lift_off_of_the_table():
    table = TABLES["two maxima"]
    amplitude = 1.3
    impacts = bb.simulate(bb.Rigid(0.1), amplitude=amplitude, impacts=300, table=table)
    rests = (impacts.contact_duration.values > 0) & (impacts.relative_bounce_velocity.values == 0)
    assert rests.any()
    leaves = (impacts.impact_phase.values + impacts.contact_duration.values)[rests]
    np.testing.assert_allclose(1 + amplitude * table(leaves, 2), 0, atol=1e-10)
    motion = bb.motion_of(bb.Rigid(0.1), amplitude=amplitude, table=table)
    assert str(motion.kind.values) == "locked"
    times = impacts.time.values[rests] + impacts.contact_duration.values[rests]
    turns = np.diff(times[-20:]) / (2 * np.pi)
    assert np.isclose(turns.cumsum(), int(motion.periods), atol=1e-9).any()


def test_the_sine_has_no_parameters():
    assert SINE.parameters == {}
    with pytest.raises(ValueError, match="along = 'harmonic_1': must be one of amplitude"):
        bb.follow(bb.orbit(bb.Rigid(0.5), amplitude=1.2), along="harmonic_1", to=2.0)


def test_a_recorded_acceleration_on_a_shaker():
    """Samples of one period in any unit; the stroke of a table and its acceleration agree."""
    table = TABLES["three harmonics"]
    recorded = 12.5 * table(2 * np.pi * np.arange(64) / 64, 2)
    shape = Table.of_samples(recorded, acceleration=True)
    given = {"frequency": 50.0, "restitution": 0.85, "contact_duration": 1e-4}
    answer = bb.on_shaker(**given, acceleration=0.8 * 9.80665, table=shape)
    again = bb.on_shaker(**given, displacement=answer.displacement, table=table)
    height = bb.orbit(answer.ball, amplitude=answer.amplitude, table=shape).max_height
    unit = 9.80665 / (100 * np.pi) ** 2
    assert answer.max_height.exact == pytest.approx(height * unit, rel=1e-9)
    assert again.max_height.exact == pytest.approx(answer.max_height.exact, rel=1e-9)
    assert "an acceleration of 0.8 times gravity (Λ = 0.8)" in str(answer)


@pytest.mark.parametrize("name", ["three harmonics", "skewed"])
def test_the_error_law_is_of_second_order_on_any_table(name):
    """Times ϖ² what it leaves, and what the corrected model leaves, tend to constants."""
    table = TABLES[name]
    left = []
    for ratio in (200.0, 400.0):
        ball = bb.SpringDamper(ratio, 0.65)
        given = {"amplitude": 0.8, "table": table}
        exact = bb.exact_errors(ball, **given)
        law = bb.law_errors(ball, **given)
        corrected = bb.exact_errors(ball, **given, simple=bb.Corrected)
        remainders = [[exact[q] - law[q], corrected[q]] for q in exact]
        left.append(ratio**2 * np.array(remainders, float))
    assert np.abs(left[1]).max() < 3
    # What is left of them is of the order 1/ϖ.
    np.testing.assert_allclose(left[0], left[1], atol=0.03)
    thresholds = bb.law_thresholds(bb.SpringDamper(1.0, restitution=0.65), **given, tolerance=1e-4)
    for quantity in ("max_height", "phase", "saddle_node"):
        error = bb.law_errors(bb.SpringDamper(thresholds[quantity], 0.65), **given)[quantity]
        assert abs(error) == pytest.approx(1e-4, rel=1e-2)


def test_an_orbit_says_of_a_table_what_is_not_said_by_its_amplitude():
    table = Table([(1, 1.0, 0.0), (3, 0.05, 0.7)])
    shown = repr(bb.orbit(bb.Rigid(0.7), amplitude=0.8, table=table))
    assert "harmonic_3" in shown and "phase_3" in shown
    assert "harmonic_1" not in shown and "phase_1" not in shown
    twice = Table([(1, 2.0, 0.0), (3, 0.1, 0.7)])
    assert "harmonic_1" in repr(bb.orbit(bb.Rigid(0.7), amplitude=0.4, table=twice))


@pytest.mark.parametrize(
    ("r", "harmonic", "doubling"),
    [(0.95, (5, 0.05, -1.8), 0.6966056985), (0.98, (4, 0.12, 0.8), 0.3609427741)],
)
def test_limits_begin_next_to_the_steepest_phase(r, harmonic, doubling):
    """The branch turns back at two other saddle-nodes between its first one and the doubling."""
    table = Table([(1, 1.0, 0.0), harmonic])
    limits = bb.limits(bb.Rigid(r), table=table)
    line = np.pi * (1 - r) / (1 + r)
    assert limits.saddle_node.amplitude == pytest.approx(line / table.slope, rel=1e-10)
    assert limits.period_doubling.amplitude == pytest.approx(doubling, abs=1e-9)
    branch = bb.follow(limits.saddle_node, to=1.0)
    folds = [special.amplitude for special in branch.special if special.kind == "saddle-node"]
    assert any(np.isclose(folds, line / table.next_low_slope, rtol=1e-3))


@pytest.mark.parametrize("level", [0.0, 1e6])
def test_harmonics_of_rounding_are_dropped(level):
    tau = 2 * np.pi * np.arange(10_000) / 10_000
    sampled_table = Table.of_samples(level + np.sin(tau) + 0.1 * np.cos(3 * tau))
    assert sampled_table.orders == (1, 3)

"""Calls about the long run, and their datasets, against orbits and each other."""

import json

import numpy as np
import pytest

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.inherited.cli.main import main
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.periodic.one_impact import n_t

R = bb.rigid(restitution=0.5)
STIFF = bb.spring_damper(restitution=0.5, frequency_ratio=100.0)
BALLS = [R, STIFF, bb.corrected(STIFF)]


@pytest.mark.parametrize("ball", BALLS)
def test_the_end_of_a_motion_is_on_it(ball):
    lam = np.array([0.5, 1.3, 1.6, 2.5, 4.0])
    found = bb.motion_of(ball, amplitude=lam, phase=0.4)
    again = bb.motion_of(
        ball, amplitude=lam[1:], phase=found.end_phase[1:], velocity=found.end_velocity[1:]
    )
    assert found.kind[0] == "permanent contact"
    for name in ("kind", "periods", "impacts"):
        assert again[name].values.tolist() == found[name][1:].values.tolist()
    # From there the next impacts of a ball that repeats are the same, one period later.
    for each in (found.isel(amplitude=k) for k in range(1, lam.size)):
        rows = int(each.impacts)
        start = (float(each.end_phase), float(each.end_velocity))
        if each.kind in ("orbit", "subharmonic"):
            sequence = ball.simulate(float(each.amplitude), *start, rows + 1)
            time = sequence.time[rows] / (2 * np.pi)
            assert time == pytest.approx(int(each.periods), abs=1e-5)


@pytest.mark.parametrize("ball", BALLS[:2])
def test_the_diagram_has_the_orbits_and_their_period_doubling(ball):
    ends = [limit.amplitude for limit in bb.limits(ball)]
    lam = np.linspace(ends[0] + 0.02, ends[1] + 0.05, 8)
    found = bb.orbit_diagram(ball, amplitude=lam, starts=2)
    orbit = n_t.orbit(ball, 1, lam)
    for k, exact in enumerate(orbit.phase):
        at = found.isel(amplitude=k)
        of = at.where((at.kind == "orbit") & (at.periods == 1) & (at.impacts == 1), drop=True)
        assert (of.start.size > 0) == (lam[k] < ends[1])
        assert of.impact_phase.count("impact").max(initial=1) == 1
        # The corrected model's orbit is compared at the start of contact, as others are.
        np.testing.assert_allclose(of.impact_phase.isel(impact=0), exact, atol=1e-5)
    doubled = found.isel(amplitude=-1)
    assert (doubled.impact_phase.where(doubled.kind == "subharmonic").count("impact") == 2).any()


def test_an_attractor_is_followed_from_where_starts_find_it():
    lam = np.linspace(1.6, 1.7, 6)
    found = bb.orbit_diagram(R, amplitude=lam, starts=1, impacts=300)
    # The orbit of period 2 at all of them up to its own doubling, 1.667.
    for k in np.flatnonzero(lam < 1.66):
        at = found.isel(amplitude=k)
        assert "subharmonic" in at.kind.values


def test_shares_are_those_of_balls_one_by_one():
    found = bb.basins(R, amplitude=1.2, starts=12, relative_velocity_max=8.0)
    assert float(found.share.sum()) == pytest.approx(1.0)
    phase, speed = np.meshgrid(found.start_phase, found.start_speed)
    velocity = 1.2 * np.cos(phase) - speed
    for k in range(0, 144, 29):
        one = bb.motion_of(R, amplitude=1.2, phase=phase.flat[k], velocity=velocity.flat[k])
        motion = found.isel(motion=int(found.destination.values.flat[k]))
        assert (one.kind, one.periods) == (motion.motion_kind, motion.motion_periods)


def test_the_exponent_is_that_of_the_motion():
    lam = [1.0, 2.0]
    ball = bb.rigid(restitution=0.95)
    found = bb.lyapunov_exponent(ball, amplitude=lam, phase=1.1, impacts=500)
    assert found.kind.values.tolist() == ["orbit", "chaotic"]
    both = bb.motion_of(ball, amplitude=lam, phase=1.1, impacts=500)
    assert found.lyapunov_exponent.identical(both.lyapunov_exponent)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (
            lambda: bb.motion_of(R, amplitude=-1.0),
            "amplitude = -1.0 is not 0 or a number in [1e-12, 1e+08]",
        ),
        (lambda: bb.orbit_diagram(R, amplitude=[]), "amplitude has no entries"),
        (lambda: bb.orbit_diagram(R, amplitude=[2.0, 1.0]), "at least one Λ, in rising order"),
        (lambda: bb.basins(R, amplitude=1.0, starts=100_000), "10000000000 balls exceed"),
        (lambda: bb.basins(R, amplitude=[1.0, 2.0]), "amplitude must be a single number"),
        (
            lambda: bb.basins(bb.rigid(restitution=[0.5, 0.6]), amplitude=1.0),
            "restitution must be a single number",
        ),
        (
            lambda: bb.basins(bb.contact_law("tsuji", restitution=0.5, duration=0.1), amplitude=1),
            "duration needs speed",
        ),
    ],
)
def test_a_mistake_is_one_line_with_what_is_allowed(call, text):
    with pytest.raises(ModelError) as error:
        call()
    assert text in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "given", [{}, {"amplitude": [1.0, 2.0, 3.0]}, {"phase": [0.1, 0.2], "amplitude": [1.0, 2.0]}]
)
def test_every_answer_draws_itself(given, tmp_path):
    given = {"amplitude": 3.0} | given
    found = [bb.motion_of(R, **given, impacts=200), bb.lyapunov_exponent(R, **given, impacts=200)]
    if "phase" in given:
        found.append(bb.orbit_diagram(R, amplitude=given["amplitude"], starts=1, impacts=50))
        found.append(bb.basins(R, amplitude=3.0, starts=5, impacts=200))
    for k, data in enumerate(found):
        data.plot(tmp_path / f"{k}.png")
        assert (tmp_path / f"{k}.png").stat().st_size > 1000


def test_the_command_line_says_the_same(capsys, tmp_path, monkeypatch):
    # Shares of other starts are not asserted here.
    monkeypatch.setattr("bouncing_ball_beyond.cli.motion._OTHER_STARTS", 2)
    main("motion --restitution 0.6 --amplitude 3 --frequency-ratio 80 --json".split())
    answer = json.loads(capsys.readouterr().out)
    assert (answer["kind"], answer["periods"], answer["impacts"]) == ("locked", 8, 11)
    picture = tmp_path / "found.png"
    wanted = "diagram --restitution 0.5 --amplitude 1 2 --points 3 --impacts 300 --json"
    wanted += f" --plot {picture}"
    main(wanted.split())
    rows = json.loads(capsys.readouterr().out)["diagram"]
    assert [row["amplitude"] for row in rows] == [1.0, 1.5, 2.0]
    assert all(sum(x["share"] for x in row["motions"]) == pytest.approx(1) for row in rows)
    assert picture.exists()
    wanted = "motion --law tsuji --set stiffness=900 --set damping=0.4 --amplitude 1"
    main(f"{wanted} --impacts 30 --json".split())
    answer = json.loads(capsys.readouterr().out)
    ball = bb.contact_law("tsuji", stiffness=900.0, damping=0.4)
    assert answer["kind"] == bb.motion_of(ball, amplitude=1.0, impacts=30).kind
    # Without losses neither motion repeats within so few impacts, nor is it known to be chaotic.
    main("diagram --restitution 1 --amplitude 1 1.2 --points 2 --impacts 60".split())
    assert "undecided (100%, because it has neither repeated nor" in capsys.readouterr().out
    with pytest.raises(SystemExit):
        main("diagram --restitution 0.5 --amplitude 2 1".split())
    assert capsys.readouterr().err.count("\n") == 1


def test_an_orbit_of_a_ball_by_its_free_impact_has_the_law_at_the_speed_of_the_first_impact():
    start = {"amplitude": 1.6, "phase": 0.3, "velocity": -3.0}
    ball = bb.contact_law("hunt-crossley", restitution=0.5, duration=0.2)
    # The free impact of the law of the orbit, at this speed.
    speed = 1.6 * np.cos(0.3) + 3.0
    found = bb.orbit_of_motion(ball, **start)
    free = found.model.signature(speed)
    assert (float(free.restitution), float(free.duration)) == pytest.approx((0.5, 0.2), abs=1e-12)
    motion = bb.motion_of(ball, **start)
    assert (found.impacts, found.periods) == (motion.impacts.item(), motion.periods.item())


@pytest.mark.parametrize("call", [bb.simulate, bb.history, bb.motion_of, bb.lyapunov_exponent])
def test_a_start_is_absolute_or_relative_to_the_table(call, refusal):
    amplitude, phase, speed = 1.2, 0.3, 2.5
    given = {"amplitude": amplitude, "phase": phase}
    absolute = call(R, velocity=amplitude * np.cos(phase) - speed, **given)
    relative = call(R, relative_velocity=-speed, **given)
    # The two velocities may differ by a rounding, and so may counts of impacts.
    for name in {"time", "ball", "kind", "lyapunov_exponent"} & set(absolute.variables):
        one, other = relative[name].values, absolute[name].values
        same = np.array_equal if one.dtype.kind == "U" else np.allclose
        assert same(one, other)
    several = call(R, relative_velocity=[-speed, -3.0], **given)
    assert several.sizes["relative_velocity"] == 2
    with refusal(ModelError, "argument relative_velocity: not allowed with argument velocity"):
        call(R, velocity=-3.0, relative_velocity=-speed, **given)
    with refusal(ModelError, "a ball that rises from the table has no impact"):
        call(R, relative_velocity=speed, **given)


def test_the_starts_of_basins_are_those_of_the_motions():
    found = bb.basins(R, amplitude=1.2, starts=6)
    for k, j in ((0, 1), (3, 4), (5, 2)):
        one = bb.motion_of(
            R,
            amplitude=1.2,
            phase=float(found.start_phase[j]),
            relative_velocity=-float(found.start_speed[k]),
        )
        kind = found.motion_kind[int(found.destination[k, j])]
        assert one.kind.item() == kind.item()

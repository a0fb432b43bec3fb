"""Orbits with a rest on the table, by simulation and by other numbers of bounces."""

import numpy as np
import pytest

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.periodic import OrbitNotFound
from bouncing_ball_beyond.tables import Table


def test_an_orbit_with_a_rest_is_that_of_a_simulated_ball():
    orbit = bb.orbit_with_rest(bb.Rigid(0.3), amplitude=1.9)
    assert orbit.lift_off == pytest.approx(np.arcsin(1 / 1.9), abs=1e-14)
    assert orbit.admissible and orbit.stable and not orbit.multipliers.any()
    start = {"phase": orbit.phase[0], "velocity": orbit.impact_velocity[0]}
    found = bb.simulate(bb.Rigid(0.3), amplitude=1.9, **start, impacts=40)
    k = orbit.impacts
    np.testing.assert_allclose(found.time[:k], orbit.times - orbit.times[0], atol=1e-11)
    np.testing.assert_allclose(-found.relative_impact_velocity[:k], orbit.speeds, atol=1e-11)
    at = int(np.flatnonzero(found.contact_duration > 0)[0])
    period = float(found.time[at + 1] - found.time[0])
    assert period == pytest.approx(2 * np.pi * orbit.periods, abs=1e-10)
    # This contact has the bounces that are summed up, and the rest.
    assert 0 < float(found.contact_duration[at]) - orbit.rest < 1e-5


@pytest.mark.parametrize(
    ("r", "end"),
    [(0.02, 2.9523855), (0.05, 2.7442047), (0.12, 2.4329624), (0.2, 2.1842397), (0.3, 1.9469385)],
)
def test_the_rest_ends_where_another_code_has_it(r, end):
    """Another code bisects between amplitudes at which a simulated ball rests, or does not rest."""
    found = []
    for start in (1.3, end - 0.1):
        branch = bb.follow(bb.orbit_with_rest(bb.Rigid(r), amplitude=start), to=3.2)
        found.append(branch.first("end of a rest").amplitude)
        assert "no longer comes to rest" in branch.end
        assert branch.admissible[:-1].all()
        assert np.all(np.diff([each.rest for each in branch.orbits]) < 0)
        assert min(each.speeds.min() for each in branch.orbits) > 0
    assert found[0] == pytest.approx(end, abs=1e-7)
    assert found[1] == pytest.approx(found[0], abs=1e-11)


def test_balls_are_locked_up_to_the_end_of_the_rest():
    ends = bb.follow(bb.orbit_with_rest(bb.Rigid(0.3), amplitude=1.9), to=2.1).values[-1]
    kinds = []
    for amplitude in (ends - 1e-5, ends + 1e-5):
        orbit = bb.orbit_with_rest(bb.Rigid(0.3), amplitude=1.9)
        start = {"phase": orbit.phase[0], "velocity": orbit.impact_velocity[0]}
        found = bb.motion_of(bb.Rigid(0.3), amplitude=amplitude, **start, impacts=500)
        kinds.append(str(found.kind.values))
    assert kinds[0] == "locked" != kinds[1]


def test_a_locked_motion_is_an_orbit_with_a_rest():
    found = bb.orbit_of_motion(bb.Rigid(0.1), amplitude=1.5)
    assert found.rest > 0
    known = bb.motion_of(bb.Rigid(0.1), amplitude=1.5)
    assert str(known.kind.values) == "locked" and int(known.periods) == found.periods


def test_an_orbit_with_a_rest_along_the_restitution_and_on_other_tables():
    orbit = bb.orbit_with_rest(bb.Rigid(0.3), amplitude=1.9)
    branch = bb.follow(orbit, along="restitution", to=(0.2, 0.32))
    for each in (branch.orbits[0], branch.orbits[-1]):
        again = bb.orbit_with_rest(each.ball, amplitude=1.9)
        assert again.rest == pytest.approx(each.rest, abs=1e-10)
        k = min(again.impacts, each.impacts)
        np.testing.assert_allclose(again.speeds[:k], each.speeds[:k], atol=1e-10)
    table = Table([(1, 1.0, 0.0), (2, 0.1, 0.4)])
    orbit = bb.orbit_with_rest(bb.Rigid(0.2), amplitude=1.6, table=table)
    branch = bb.follow(orbit, along="harmonic_2", to=0.12)
    there = bb.orbit_with_rest(bb.Rigid(0.2), amplitude=1.6, table=branch.orbits[-1].table)
    assert there.rest == pytest.approx(branch.orbits[-1].rest, abs=1e-10)


def test_datasets_of_orbits_with_a_rest(tmp_path):
    branch = bb.follow(bb.orbit_with_rest(bb.Rigid(0.3), amplitude=1.9), to=2.1)
    file = tmp_path / "rests.nc"
    bb.to_dataset(branch).to_netcdf(file)
    back = bb.read_orbits(file)
    assert back.first("end of a rest").distance(branch.first("end of a rest")) == 0
    assert back.orbits[0].rest == branch.orbits[0].rest
    assert bb.plot(back, quantity="max_height").axes


def test_where_there_is_no_rest_it_is_said():
    with pytest.raises(OrbitNotFound, match="never falls faster than a ball"):
        bb.orbit_with_rest(bb.Rigid(0.3), amplitude=0.9)
    with pytest.raises(OrbitNotFound, match="does not come to rest"):
        bb.orbit_with_rest(bb.Rigid(0.95), amplitude=2.0)
    with pytest.raises(ValueError, match="must have impacts at the level"):
        bb.orbit_with_rest(bb.SpringDamper(20.0, 0.3), amplitude=1.9)


def test_the_end_of_a_rest_on_a_table_that_is_not_a_sine():
    """On both sides of the end, simulated balls come to rest and do not come to rest."""
    table = Table([(1, 1.0, 0.0), (2, 0.3, 1.0)])
    start = bb.orbit_with_rest(bb.Rigid(0.3), amplitude=1.1, table=table)
    end = bb.follow(start, to=1.6).first("end of a rest").amplitude
    assert end == pytest.approx(1.538304135, abs=1e-9)
    assert bb.orbit_with_rest(bb.Rigid(0.3), amplitude=end - 1e-6, table=table).rest > 0
    with pytest.raises(OrbitNotFound):
        bb.orbit_with_rest(bb.Rigid(0.3), amplitude=end + 1e-6, table=table)

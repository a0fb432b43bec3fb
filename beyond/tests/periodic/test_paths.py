"""Orbits along paths of parameters: a shaker that sweeps its frequency, and functions of a user."""

import pickle
from typing import ClassVar

import numpy as np
import pytest
from scipy.optimize import brentq

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.inherited.errors import ModelError, NoOrbitError, ParameterError
from bouncing_ball_beyond.periodic.orbits.impacts import equations_of

# A stroke of 0.5 mm below a ball on a contact of 500 Hz, in SI units.
STROKE = 0.5e-3
GRAVITY = 9.80665
OF_CONTACT = 500.0
RESTITUTION = 0.85


def amplitude_at(hertz):
    """Λ = aΩ²/g."""
    return STROKE * (2 * np.pi * hertz) ** 2 / GRAVITY


def spring_at(hertz):
    return bb.spring_damper(restitution=RESTITUTION, frequency_ratio=OF_CONTACT / hertz)


def rigid_at(_):
    return bb.rigid(restitution=RESTITUTION)


def hertzian_at(hertz):
    """K = k (g/Ω²)^{1/2}/(mΩ²) of a stiffness k in N/m^{3/2}, and a damping in s/m times g/Ω."""
    stiffness = 500.0 * (20.0 / hertz) ** 3
    return bb.contact_law("hunt-crossley", stiffness=stiffness, damping=0.01 * 20.0 / hertz)


def corrected_at(hertz):
    return bb.corrected(spring_at(hertz))


def doubling_by_roots(ball_at):
    """The frequency at which the doubling of ``limits`` is at the Λ of the table."""

    def above(hertz):
        return bb.limits(ball_at(hertz)).period_doubling.amplitude - amplitude_at(hertz)

    return brentq(above, 20.0, 25.0, rtol=1e-13)


def in_hertz(frequency):
    """A frequency over √(g/a)."""
    return frequency * np.sqrt(GRAVITY / STROKE) / (2 * np.pi)


@pytest.mark.parametrize(
    ("ball_at", "published"),
    # Located by root-finding on limits outside of this package's continuation.
    [(spring_at, 22.7010), (rigid_at, 22.7121), (corrected_at, None), (hertzian_at, None)],
)
def test_a_sweep_doubles_where_the_limits_of_the_balls_say(ball_at, published):
    start = bb.orbit(ball_at(20.0), amplitude=amplitude_at(20.0))
    found = bb.follow(start, along="frequency", to=1.2).to_dataset()
    doubling = found.first("period doubling")
    hertz = in_hertz(doubling.parameters["frequency"])
    assert hertz == pytest.approx(doubling_by_roots(ball_at), rel=1e-10)
    assert published is None or hertz == pytest.approx(published, abs=5e-5)
    assert found.special_frequency[-1] == doubling.parameters["frequency"]
    # All balls on the branch are the one ball at another frequency of the table.
    for orbit in found.states():
        here = in_hertz(np.sqrt(orbit.amplitude))
        there = bb.orbit(ball_at(here), amplitude=orbit.amplitude)
        assert float(orbit.distance(there)) < 1e-11


def test_the_doubled_branch_of_a_sweep_is_a_sweep():
    start = bb.orbit(spring_at(20.0), amplitude=amplitude_at(20.0))
    doubling = bb.follow(start, along="frequency", to=1.2).first("period doubling")
    twice = bb.follow(doubling, to=1.05).to_dataset()
    assert twice.attrs["along"] == "frequency" and twice.attrs["impacts"] == 2
    *_, last = twice.states()
    hertz = in_hertz(1.05)
    assert last.parameters == {"frequency": pytest.approx(1.05, rel=1e-14)}
    assert last.amplitude == pytest.approx(amplitude_at(hertz), rel=1e-12)
    assert last.law.frequency_ratio == pytest.approx(OF_CONTACT / hertz, rel=1e-12)
    # A ball ends there, in the simulation of this ball on this table.
    ball = bb.spring_damper(restitution=RESTITUTION, frequency_ratio=last.law.frequency_ratio)
    simulated = bb.orbit_of_motion(ball, amplitude=last.amplitude)
    first = simulated.phases[np.argmin(np.abs(simulated.phases - last.phases[0]))]
    assert first == pytest.approx(last.phases[0], abs=1e-9)


def test_along_its_range_the_parameters_of_a_sweep_are_in_theirs(refusal):
    start = bb.orbit(spring_at(20.0), amplitude=amplitude_at(20.0))
    with refusal(ParameterError, "to = 1000000000.0 is not a number in [1e-06, 10000]"):
        bb.follow(start, along="frequency", to=1e9)
    # Λ = f² has a range, and so has ϖ, which is 5e7 at f = √Λ and falls as 1/f.
    allowed = equations_of(start, "frequency")[0].balls.range_of("frequency")
    assert (allowed.low, allowed.high) == (pytest.approx(1e-6), pytest.approx(1e4))
    stiff = bb.orbit(bb.spring_damper(restitution=0.85, frequency_ratio=5e7), amplitude=0.9)
    allowed = equations_of(stiff, "frequency")[0].balls.range_of("frequency")
    assert (allowed.low, allowed.high) == (pytest.approx(0.5 * 0.9**0.5), pytest.approx(1e4))


def hertz_path(**changed):
    functions = {"amplitude": amplitude_at, "frequency_ratio": lambda f: OF_CONTACT / f}
    return bb.ParameterPath("hertz", low=15.0, high=30.0, **functions | changed)


def test_functions_of_one_variable_are_a_path():
    """The same sweep in hertz, and its doubled orbits on the same path."""
    start = bb.orbit(spring_at(20.0), amplitude=amplitude_at(20.0))
    found = bb.follow(start, along=hertz_path(), to=25.0).to_dataset()
    doubling = found.first("period doubling")
    assert found.special_hertz.values == pytest.approx(doubling_by_roots(spring_at), rel=1e-10)
    assert float(found.hertz[0]) == pytest.approx(20.0, rel=1e-12)
    assert doubling.parameters == {
        "amplitude": doubling.amplitude,
        "frequency_ratio": doubling.law.frequency_ratio,
    }
    twice = bb.follow(doubling, along=hertz_path(), to=25.0).to_dataset()
    assert twice.attrs["impacts"] == 2 and float(twice.hertz[-1]) == pytest.approx(25.0)
    assert "hertz" in found.plot().axes[0].get_xlabel()


def test_the_orbits_of_a_path_come_back_from_a_file_and_a_pickle(tmp_path):
    start = bb.orbit(spring_at(20.0), amplitude=amplitude_at(20.0))
    for along, to in (("frequency", 1.2), (hertz_path(), 25.0)):
        found = bb.follow(start, along=along, to=to).to_dataset()
        found.to_netcdf(tmp_path / "branch.nc")
        for again in (bb.read_orbits(tmp_path / "branch.nc"), pickle.loads(pickle.dumps(found))):
            assert list(again.states()) == list(found.states())
            assert again.first("period doubling") == found.first("period doubling")
        doubling = found.first("period doubling")
        assert pickle.loads(pickle.dumps(doubling)) == doubling
        assert bb.normal_form(doubling).is_supercritical


def test_a_curve_of_doublings_over_a_sweep_and_the_restitution():
    start = bb.orbit(spring_at(20.0), amplitude=amplitude_at(20.0))
    doubling = bb.follow(start, along="frequency", to=1.2).first("period doubling")
    curve = bb.follow(
        doubling, along=("frequency", "restitution"), ranges={"restitution": (0.7, 0.9)}
    ).to_dataset()
    r, hertz = float(curve.restitution[0]), in_hertz(float(curve.frequency[0]))

    def other(here):
        return bb.spring_damper(restitution=r, frequency_ratio=OF_CONTACT / here)

    assert sorted(curve.restitution.values[[0, -1]]) == pytest.approx([0.7, 0.9])
    assert hertz == pytest.approx(doubling_by_roots(other), rel=1e-9)


def test_an_orbit_that_is_not_on_its_path_is_refused(refusal):
    start = bb.orbit(spring_at(20.0), amplitude=amplitude_at(20.0))
    with refusal(NoOrbitError, "the orbit is not on the path: frequency_ratio = 25, and 30"):
        bb.follow(start, along=hertz_path(frequency_ratio=lambda f: 600.0 / f), to=25.0)
    with refusal(NoOrbitError, "amplitude = 0.805", "of the orbit is not on the path, whose"):
        bb.follow(start, along=hertz_path(amplitude=lambda f: f), to=25.0)
    with refusal(ParameterError, "on the path restitution =", "is not a number in"):
        bb.follow(start, along=hertz_path(restitution=lambda f: 0.85 + (f - 20) / 30), to=25.0)
    with refusal(ParameterError, "these orbits have no 'mass': one of"):
        bb.follow(start, along=hertz_path(mass=lambda f: f), to=25.0)
    with refusal(ParameterError, "frequency_ratio follows from frequency: both cannot vary"):
        bb.follow(bb.limits(spring_at(20.0)).saddle_node, along=("frequency", "frequency_ratio"))
    with refusal(ParameterError, "has two paths"):
        bb.follow(bb.limits(spring_at(20.0)).saddle_node, along=("frequency", hertz_path()))
    with refusal(ParameterError, "a path needs a function for each parameter"):
        bb.ParameterPath("hertz", low=1.0, high=2.0)
    with refusal(ParameterError, "name = 'amplitude' is also that of a parameter"):
        bb.ParameterPath("amplitude", low=1.0, high=2.0, amplitude=abs)
    with refusal(ParameterError, "high = 1.0 is not a finite number > 2"):
        bb.ParameterPath("hertz", low=2.0, high=1.0, amplitude=abs)


def test_a_law_without_units_does_not_tell_how_it_follows_the_frequency(refusal):
    class Undeclared(bb.SpringDamper):
        units: ClassVar[dict] = {}

    model = bb.ContactModel(Undeclared(20.0, 0.1))
    orbit = bb.orbit(model, amplitude=0.9)
    with refusal(ModelError, "Undeclared declares no unit of its parameter frequency_ratio"):
        bb.follow(orbit, along="frequency", to=1.1)

"""Orbits, branches and curves that are saved and come back, or are computed in other processes."""

import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from typing import ClassVar

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

import bouncing_ball_beyond
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

LINEAR = bouncing_ball_beyond.spring_damper(restitution=0.85, frequency_ratio=10.0)


@dataclass(frozen=True, repr=False)
class Cubic(ContactLaw):
    """A law that the library does not have."""

    stiffness: float
    damping: float

    name: ClassVar[str] = "cubic"

    def force(self, penetration, rate):
        return self.stiffness * penetration**3 + self.damping * penetration * rate


BALLS = {
    "rigid": bouncing_ball_beyond.rigid(restitution=0.5),
    "linear": LINEAR,
    "force": bouncing_ball_beyond.spring_damper(
        restitution=0.5, frequency_ratio=20.0, release="force"
    ),
    "hertz": bouncing_ball_beyond.contact_law("hunt-crossley", stiffness=1e4, damping=0.1),
    "corrected": bouncing_ball_beyond.corrected(LINEAR),
    "own law": ContactModel(Cubic(2e4, 20.0)),
}


def _written_and_read(data, folder):
    path = folder / "orbits.nc"
    data.to_netcdf(path)
    return bouncing_ball_beyond.read_orbits(path)


def _same_bits(one, other):
    """Whether two orbits have the same fields: a number prints with all the digits that it has."""
    return one == other and repr(vars(one.model)) == repr(vars(other.model))


@pytest.mark.parametrize("name", BALLS)
def test_a_branch_comes_back_from_a_file_with_the_same_bits(name, tmp_path):
    one = bouncing_ball_beyond.orbit(BALLS[name], amplitude=1.2)
    assert _written_and_read(one.to_dataset(), tmp_path) == one
    for along, value in one.model.numbers().items():
        found = bouncing_ball_beyond.follow(one, along=along, to=1.02 * float(value)).to_dataset()
        again = _written_and_read(found, tmp_path)
        assert type(again) is type(found) and again.identical(found)
        orbits = list(found.states())
        assert len(orbits) == found.sizes["point"] >= 2
        assert all(map(_same_bits, orbits, again.states()))
        # The orbits in the file solve the equations to rounding, with the parameters in the file;
        # a contact by collocation is known to about 1e-12.
        assert max(orbit.defect() for orbit in again.states()) < 1e-11
        values = [orbit.parameters[along] for orbit in orbits]
        np.testing.assert_allclose(values, found[along], rtol=1e-15)


def test_a_curve_comes_back_and_its_orbits_are_followed(tmp_path):
    one = bouncing_ball_beyond.orbit(LINEAR, amplitude=1.0)
    doubling = bouncing_ball_beyond.follow(one, to=1.2).first("period doubling")
    found = bouncing_ball_beyond.follow(doubling, along=("amplitude", "restitution"), points=10)
    curve = found.to_dataset()
    again = _written_and_read(curve, tmp_path)
    assert [*found.states()] == [*curve.states()] == [*again.states()]
    assert type(again) is type(curve) and again.attrs["curve_kind"] == "period doubling"
    last = [*again.states()][-1]
    assert last.kind == "period doubling" and last.along == ("amplitude", "restitution")
    twice = bouncing_ball_beyond.follow(last, to=1.02 * last.amplitude, points=10).to_dataset()
    assert twice.attrs["impacts"] == 2


def test_an_orbit_of_several_impacts_and_a_row_come_back(tmp_path):
    one = bouncing_ball_beyond.orbit_of_motion(BALLS["rigid"], amplitude=1.6)
    assert one.impacts == 2
    assert _written_and_read(one.to_dataset(), tmp_path) == one
    row = Orbit.of(ContactModel(SpringDamper([5.0, 10.0], 0.05)), 1, [0.9, 1.0], 0.7, 0.3)
    again = _written_and_read(row.to_dataset(), tmp_path)
    assert again.shape == (2,) and all(again[k] == row[k] for k in range(2))


def test_what_is_selected_copied_or_pickled_keeps_its_orbits():
    one = bouncing_ball_beyond.orbit(LINEAR, amplitude=1.0)
    found = bouncing_ball_beyond.follow(one, to=1.2).to_dataset()
    orbits = list(found.states())
    assert [*found.isel(point=3).states()] == [orbits[3]]
    assert [*found.isel(point=[4, 1]).states()] == [orbits[4], orbits[1]]
    copies = (
        found.copy(deep=True),
        pickle.loads(pickle.dumps(found)),
        found.sel(point=found.point),
    )
    for same in copies:
        assert [*same.states()] == orbits
        assert same.first("period doubling") == found.first("period doubling")


def test_the_figures_are_drawn_into_given_axes():
    one = bouncing_ball_beyond.orbit(bouncing_ball_beyond.rigid(restitution=0.85), amplitude=0.9)
    found = bouncing_ball_beyond.follow(one, to=1.2)
    doubling = found.first("period doubling")
    curve = bouncing_ball_beyond.follow(doubling, along=("amplitude", "restitution"), points=10)
    figure, panels = plt.subplots(1, 2)
    for result, axes in zip((found, curve), panels, strict=True):
        assert result.plot(ax=axes) is figure and axes.lines
    plt.close(figure)


@pytest.mark.parametrize("content", ["another dataset", "text"])
def test_a_foreign_file_is_refused_in_one_line(content, tmp_path, refusal):
    path = tmp_path / "foreign.nc"
    if content == "text":
        path.write_text("no netCDF")
        expected = f"{path} is damaged"
    else:
        xr.Dataset({"phase": ("point", [0.5])}).to_netcdf(path)
        expected = "contains no orbits: it is no result of branch, and no to_dataset() of an"
    with refusal(ModelError, expected):
        bouncing_ball_beyond.read_orbits(path)
    with refusal(ModelError, "source = 3 is neither a path nor a dataset"):
        bouncing_ball_beyond.read_orbits(3)
    # Python writes no number of so many digits.
    with refusal(ModelError, "source = a whole number of more than 4300 digits is neither a path"):
        bouncing_ball_beyond.read_orbits(10**5000)
    with refusal(ModelError, "no dataset"):
        bouncing_ball_beyond.read_orbits(tmp_path / "missing.nc")


def test_a_law_that_is_not_defined_is_named(refusal):
    data = bouncing_ball_beyond.orbit(BALLS["own law"], amplitude=1.2).to_dataset()
    other = data.ball_model.item().replace("Cubic", "Quartic")
    with refusal(ModelError, "Quartic is no model or law of the library: import its class first"):
        bouncing_ball_beyond.read_orbits(data.assign(ball_model=other))
    with refusal(ModelError, "is not the text of a model"):
        bouncing_ball_beyond.read_orbits(data.assign(ball_model="{}"))


def test_branches_in_another_process_have_the_same_bytes():
    starts = [bouncing_ball_beyond.orbit(LINEAR, n, amplitude=1.0) for n in (1, 2)]
    call = partial(bouncing_ball_beyond.follow, along="restitution", to=0.83)
    here = list(map(call, starts))
    spawned = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=spawned) as pool:
        there = list(pool.map(call, starts))
    for one, other in zip(here, there, strict=True):
        assert [*one.states()] == [*other.states()]
        here, there = one.to_dataset(), other.to_dataset()
        assert type(here) is type(there) and here.identical(there)
        for name in here.variables:
            assert here[name].values.tobytes() == there[name].values.tobytes()

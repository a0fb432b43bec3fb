"""The cross-check: all routes to the accepted orbits agree, and a wrong orbit is detected."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from declared_artifacts import read_by

from bouncing_ball.models.simulation import next_impact
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.claims import witness as witnesses
from bouncing_ball.paper.claims.claim_tables import witness as rows
from bouncing_ball.paper.claims.witness import (
    CLOSES,
    FORMULA,
    all_orbits,
    formula_and_equations,
    witness,
)
from bouncing_ball.paper.exhibits.continuation_of_orbits import Domains, orbit_branches
from bouncing_ball.periodic.continuation import PaperEquations
from bouncing_ball.periodic.orbit import monodromy


@pytest.fixture(scope="module")
def result(recorded, described):
    names = read_by("witness")
    return described(witness({name: recorded[name] for name in names}))


def off(name, data):
    """The kinds of comparison in which an orbit of a dataset exceeds the budget."""
    found = witness({name: data}).squeeze("artifact")
    return set(found.comparison.values[found.disagreement > found.budget])


def test_all_routes_agree_on_all_that_is_shown(result, recorded):
    compared = result.orbits > 0
    assert (np.isnan(result.disagreement) == ~compared).all()
    assert (result.disagreement <= result.budget).where(compared, True).all()
    assert (result.orbits.sel(comparison=FORMULA) > 0).all()
    # Nothing that an earlier run compared is left out.
    assert (result.orbits >= recorded["witness"].orbits.sel(comparison=result.comparison)).all()
    # All points of three branches, and their bifurcations.
    assert result.orbits.sel(artifact="fig08", comparison=FORMULA).item() == 1803 + 9


ORBITS = {name for name in read_by("witness") if name != "table1"}


@pytest.mark.parametrize(("name", "k"), [*((name, 0) for name in sorted(ORBITS)), ("fig15", 1)])
def test_the_multipliers_are_those_of_the_simulated_map(recorded, name, k):
    found = [one for one in all_orbits(name, recorded[name]) if not one.bifurcation]
    assert len(found) == (2 if name == "fig15" else 1)
    orbit = found[k].orbit[found[k].admissible.astype(bool)]
    phase = orbit.phase
    speed = orbit.relative_impact_velocity
    cycle = partial(next_impact, orbit.model, amplitude=orbit.amplitude)
    step = 1e-6 * np.abs(speed)
    matrix = monodromy(orbit)
    # Central differences: the rounding of a cycle's time over the step, which is small near
    # permanent contact, is above the truncation, 1e-12 times a third derivative.
    rounding = 100 * np.finfo(float).eps * 2 * np.pi * orbit.n / step
    for k, (later, faster) in enumerate([(step, 0.0), (0.0, step)]):
        ahead, behind = (cycle(phase + x * later, speed + x * faster) for x in (1, -1))
        turned = reduce_angle(ahead.phase - behind.phase)
        column = np.array([turned, ahead.velocity - behind.velocity])
        off = np.abs(column / (2 * step) - matrix[..., k].T)
        assert orbit.size and np.all(off <= rounding * np.abs(matrix).max((-2, -1)))


@pytest.mark.parametrize(
    ("name", "variables"),
    [
        ("fig02", "phase"),
        ("fig03", "phase saddle_node_amplitude period_doubling_phase"),
        ("fig05", "phase contact_duration"),
        ("fig06", "impact_velocity"),
        ("fig08", "amplitude"),
        ("fig09", "special_amplitude special_phase"),
        ("fig15", "restitution_phase restitution_amplitude phase"),
        ("table1", "computed special_contact_duration"),
    ],
)
def test_a_number_that_is_off_is_seen(recorded, name, variables):
    for variable in variables.split():
        data = recorded[name].copy(deep=True)
        data[variable].values[...] *= 1 + 1e-9
        assert off(name, data), variable


def test_other_parameters_than_those_of_the_orbits_are_seen(recorded):
    for name in ("fig02", "fig08", "table1"):
        assert FORMULA in off(name, recorded[name].assign_attrs(restitution=0.8501))
    for other in ({"release": "force"}, {"n": 2}):
        assert FORMULA in off("fig08", recorded["fig08"].assign_attrs(other))


def test_one_orbit_that_is_not_a_number_is_seen(recorded):
    data = recorded["fig05"].copy(deep=True)
    data.phase.values[2, 7] = np.nan
    assert np.isposinf(witness({"fig05": data}).disagreement).any()


@pytest.mark.parametrize(
    ("where", "blind", "replacement"),
    [
        (witnesses, "nearest", lambda orbit: orbit),
        (PaperEquations, "residual", lambda self, y: 0 * y[..., 1:]),
    ],
)
def test_formula_and_equations_each_see_what_is_off(
    recorded, monkeypatch, where, blind, replacement
):
    data = recorded["fig05"].copy(deep=True)
    data.phase.values[:] += 1e-9
    monkeypatch.setattr(where, blind, replacement)
    assert FORMULA in off("fig05", data)


def test_the_phase_of_a_bifurcation_is_compared_itself(recorded, monkeypatch):
    # The nearest point of the branch alone does not see what is off across the branch.
    first = next(all_orbits("table1", recorded["table1"]))
    near = witnesses.nearest(first.orbit)
    monkeypatch.setattr(witnesses, "nearest", lambda orbit: near)
    moved = replace(first.orbit, phase=first.orbit.phase + 1e-9)
    found = formula_and_equations(first._replace(orbit=moved))
    assert found == pytest.approx(np.full(moved.size, 1e-9), rel=0.01)


def test_where_the_equations_have_no_derivatives_no_orbit_is_found(recorded, monkeypatch):
    original = PaperEquations.jacobian
    monkeypatch.setattr(PaperEquations, "jacobian", lambda self, y: np.nan * original(self, y))
    found = witness({"fig05": recorded["fig05"]})
    assert np.isposinf(found.disagreement.sel(comparison=FORMULA)).all()


def test_the_comparison_with_the_simulation_can_fail(recorded, monkeypatch):
    def late(*start):
        cycle = next_impact(*start)
        return cycle._replace(time=cycle.time + 1e-7)

    monkeypatch.setattr(witnesses, "next_impact", late)
    assert off("fig08", recorded["fig08"]) == {CLOSES}


@pytest.mark.parametrize(
    ("name", "variable"),
    [
        ("fig05", "contact_duration"),
        ("fig15", "contact_duration"),
        ("fig15", "restitution_phase"),
        ("fig03", "amplitude"),
        ("fig03", "saddle_node_amplitude"),
        ("fig08", "special_amplitude"),
        ("table1", "computed"),
    ],
)
def test_a_renamed_variable_is_no_reason_to_compare_nothing(recorded, name, variable):
    with pytest.raises(KeyError, match=variable):
        witness({name: recorded[name].rename({variable: "renamed"})})


def test_all_routes_agree_under_the_force_release_too(continuation_settings):
    parameters = {
        "n": 1,
        "restitution": 0.85,
        "frequency_ratio": [10.0, 2.0],
        "amplitude_max": 1.5,
        "points": 41,
    }
    data = orbit_branches(Domains(**parameters), "force", continuation_settings)
    data.attrs = parameters | {"release": "force"}
    result = witness({"fig08": data})
    assert (result.disagreement <= result.budget).all()
    assert result.orbits.sel(artifact="fig08", comparison=FORMULA).item() == 82 + 7
    assert (result.orbits > 0).all()


def test_the_table_says_the_bounds_and_the_counts(result):
    header, body = rows(result)
    assert header == ["artifact", FORMULA, CLOSES]
    assert body[0][1:] == ["1e-11", "1e-10"]
    (line,) = [line for line in body if line[0] == "fig08"]
    assert line[1:] == ["≤ 1e-11 (1812)", "≤ 1e-10 (1803)"]
    (line,) = [line for line in body if line[0] == "table1"]
    assert line[1:] == ["≤ 1e-11 (18)", "–"]

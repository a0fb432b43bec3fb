"""The cross-check: the accepted datasets agree, and a wrong orbit is detected."""

from dataclasses import replace

import numpy as np
import pytest

from bouncing_ball.claims.witness import (
    BUDGETS,
    CLOSES,
    FORMULA,
    HOLDS,
    LEAVES,
    SHOWN,
    formula_and_equations,
    located,
    witness,
)
from bouncing_ball.continuation.corrector import newton
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import ModelError
from bouncing_ball.figures.tables.rows import witness as rows
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.studies.orbit_branches import Domains, orbit_branches


@pytest.fixture(scope="module")
def result(recorded, described, table):
    assert table["witness"]["reads"] == list(SHOWN)
    return described(witness({name: recorded[name] for name in SHOWN}))


def test_all_routes_agree_on_all_that_is_shown(result, recorded):
    assert result.artifact.values.tolist() == list(SHOWN)
    compared = result.orbits > 0
    assert (np.isnan(result.disagreement) == ~compared).all()
    assert (result.disagreement <= result.budget).where(compared, True).all()
    # Nothing that an earlier run compared is left out.
    accepted = recorded["witness"].orbits
    assert (result.orbits >= accepted.sel(artifact=result.artifact)).all()
    assert (result.orbits.sel(comparison=FORMULA) > 0).all()
    # All points of three branches, and their bifurcations.
    assert result.orbits.sel(artifact="fig08", comparison=FORMULA).item() == 1803 + 9


@pytest.mark.parametrize(
    ("name", "variable"),
    [
        ("fig02", "phase"),
        ("fig03", "phase"),
        ("fig03", "saddle_node_amplitude"),
        ("fig03", "period_doubling_phase"),
        ("fig05", "phase"),
        ("fig05", "contact_duration"),
        ("fig06", "impact_velocity"),
        ("fig08", "amplitude"),
        ("fig09", "special_amplitude"),
        ("fig09", "special_phase"),
        ("fig15", "restitution_phase"),
        ("fig15", "restitution_amplitude"),
        ("fig15", "phase"),
        ("table1", "computed"),
        ("table1", "special_contact_duration"),
    ],
)
def test_a_number_that_is_off_is_seen(recorded, name, variable, refusal):
    data = recorded[name].copy(deep=True)
    values = data[variable].values
    values *= 1 + 1e-9
    with refusal(ModelError, f"{name}: ", " disagree by "):
        witness({name: data})


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("fig08", {"restitution": 0.8501}),
        ("fig08", {"release": "force"}),
        ("fig08", {"n": 2}),
        ("fig02", {"restitution": 0.8501}),
        ("table1", {"restitution": 0.8501}),
    ],
)
def test_other_parameters_than_those_of_the_orbits_are_seen(recorded, name, change):
    with pytest.raises(ModelError, match=f"{name}: {FORMULA} disagree"):
        witness({name: recorded[name].assign_attrs(change)})


def test_one_orbit_that_is_not_a_number_is_seen(recorded):
    data = recorded["fig05"].copy(deep=True)
    data.phase.values[2, 7] = np.nan
    with pytest.raises(ModelError, match="disagree by inf"):
        witness({"fig05": data})


@pytest.mark.parametrize("blind", ["nearest", "system"])
def test_formula_and_equations_each_see_what_is_off(recorded, monkeypatch, blind):
    data = recorded["fig05"].copy(deep=True)
    data.phase.values[:] += 1e-9
    with monkeypatch.context() as patch:
        if blind == "nearest":
            patch.setattr(SpringDamperModel, "nearest", lambda self, orbit: orbit)
        else:
            patch.setattr("bouncing_ball.claims.witness._by_equations", lambda _, near: near)
        with pytest.raises(ModelError, match=FORMULA):
            witness({"fig05": data})


def test_the_phase_of_a_bifurcation_is_compared_itself(recorded, monkeypatch):
    # The nearest point of the branch alone does not see what is off across the branch.
    shown = next(located(recorded["table1"]))
    near = shown.model.nearest(shown.orbit)
    monkeypatch.setattr(SpringDamperModel, "nearest", lambda self, orbit: near)
    off = replace(shown.orbit, phase=shown.orbit.phase + 1e-9)
    expected = 1e-9 / np.maximum(off.n, off.amplitude)
    assert formula_and_equations(shown._replace(orbit=off)) == pytest.approx(expected, rel=0.01)


def test_what_newtons_method_has_not_found_is_no_orbit(recorded, monkeypatch):
    def stuck(*arguments):
        found = newton(*arguments)
        return found._replace(converged=found.converged & False, residual=found.residual + 2e-11)

    monkeypatch.setattr("bouncing_ball.claims.witness.newton", stuck)
    with pytest.raises(ModelError, match="disagree by inf"):
        witness({"fig05": recorded["fig05"]})


@pytest.mark.parametrize(
    ("part", "change", "kind"),
    [
        ("monodromy", lambda m: m * (1 + 1e-3), LEAVES),
        ("cycle", lambda c: c._replace(time=c.time + 1e-7), CLOSES),
        ("cycle", lambda c: c._replace(relative_velocity=c.relative_velocity * (1 + 2e-11)), HOLDS),
    ],
)
def test_each_comparison_with_the_simulation_can_fail(recorded, monkeypatch, part, change, kind):
    original = getattr(SpringDamperOrbit, part)
    monkeypatch.setattr(SpringDamperOrbit, part, lambda self, *x: change(original(self, *x)))
    with pytest.raises(ModelError, match=kind):
        witness({"fig08": recorded["fig08"]})


@pytest.mark.parametrize(
    ("name", "variable"),
    [
        ("fig05", "contact_duration"),
        ("fig15", "contact_duration"),
        ("fig15", "restitution_phase"),
        ("fig03", "amplitude"),
        ("table1", "special_phase"),
    ],
)
def test_a_renamed_variable_is_no_reason_to_compare_nothing(recorded, name, variable):
    with pytest.raises(KeyError, match=variable):
        witness({name: recorded[name].rename({variable: "renamed"})})


def test_an_empty_comparison_fails(recorded, refusal):
    data = recorded["fig05"]
    empty = data.assign(contact_duration=data.contact_duration * np.nan)
    with refusal(ModelError, "fig05: contact_orbits compares nothing"):
        witness({"fig05": empty})


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_both_rules_of_release(release, continuation_settings):
    parameters = {
        "n": 1,
        "restitution": 0.85,
        "frequency_ratio": [10.0, 2.0],
        "amplitude_max": 1.5,
        "points": 41,
    }
    data = orbit_branches(Domains(**parameters), release, continuation_settings)
    data.attrs = parameters | {"release": release}
    result = witness({"fig08": describe(data)})
    assert (result.disagreement <= result.budget).all()
    assert result.orbits.sel(artifact="fig08", comparison=FORMULA).item() == 82 + 7
    assert (result.orbits > 0).all()


def test_the_table_says_the_bounds_and_the_counts(result):
    header, body = rows(result)
    assert header == ["artifact", *BUDGETS]
    assert body[0][1:] == ["1e-11", "1e-10", "1e-09", "1e-05"]
    (line,) = [line for line in body if line[0] == "fig08"]
    assert line[1:] == ["≤ 1e-11 (1812)", "≤ 1e-10 (1803)", "≤ 1e-09 (764)", "≤ 1e-05 (1013)"]
    (line,) = [line for line in body if line[0] == "table1"]
    assert line[1:] == ["≤ 1e-11 (18)", "–", "–", "–"]

"""Figures 5, 6, 10 and 13: orbits along ϖ."""

import itertools

import numpy as np
import pytest

from bouncing_ball.datasets.parameters import Span
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.paper.exhibits import apparent_restitution_figures as figures
from bouncing_ball.paper.exhibits.apparent_restitution import (
    Case,
    Cases,
    apparent_restitution,
    frequency_sweep,
    poincare_map,
)
from bouncing_ball.pipeline.job import typed

# As the configuration gives them.
apparent_restitution, frequency_sweep = map(typed, (apparent_restitution, frequency_sweep))

SPAN = {"min": 1.0, "max": 1000.0, "samples": 7}
CASES = {
    "n": 1,
    "cases": [
        {"restitution": 1.0, "amplitude": 0.8},
        {"restitution": 0.65, "amplitude": 1.0},
        {"restitution": 0.10, "amplitude": 2.6},
    ],
    "frequency_ratio": SPAN,
}


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_every_entry_is_an_orbit_of_its_parameters(described, reference, release):
    # Off the resonance at ϖ = 1, where the paper's solution of the elastic contact has no value.
    data = described(
        apparent_restitution(CASES | {"frequency_ratio": SPAN | {"min": 1.5}}, release)
    )
    assert data.phase.dims == ("case", "frequency_ratio") and data.phase.shape == (3, 7)
    # xarray names the curves by the case, and draws the first variable.
    names = [f"r = {x['restitution']:g}, Λ = {x['amplitude']:g}" for x in CASES["cases"]]
    assert data.case.values.tolist() == names and next(iter(data)) == "apparent_restitution"
    for (i, case), ratio in itertools.product(
        enumerate(CASES["cases"]), data.frequency_ratio.values
    ):
        at = data.isel(case=i).sel(frequency_ratio=ratio)
        r = float(at.restitution)
        lam = float(at.amplitude)
        assert (r, lam) == tuple(case.values())
        if np.isnan(at.phase):
            assert not bool(at.stable)
            continue
        phase = float(at.phase)
        speed = float(at.impact_velocity - lam * np.cos(at.phase))
        duration = float(at.contact_duration)
        zeta = float(damping_ratio(r))
        end = reference.cycle(
            phase,
            speed,
            n=1,
            lam=lam,
            omega=ratio,
            zeta=zeta,
            duration=duration,
            force_release=release == "force",
        )
        # The roundings of the events, over a flight of some 2π.
        assert end == pytest.approx((phase + 2 * np.pi, speed), abs=1e-11)
        assert float(at.release_phase) == pytest.approx(phase + duration, abs=1e-15)


def test_not_stable_where_there_is_no_orbit():
    # r = 0.1 needs Λ ≥ 2.57 when stiff; the configuration does not allow less.
    cases = Cases.model_construct(
        n=1, cases=(Case(restitution=0.10, amplitude=2.0),), frequency_ratio=Span(**SPAN)
    )
    data = apparent_restitution(cases, "displacement")
    gone = np.isnan(data.phase.values)
    assert gone[0, -1]
    assert not data.stable.values[gone].any()
    assert np.isnan(data.max_height.values[gone]).all()


def test_the_orbits_of_a_sweep_tend_to_those_of_the_restitution_model(described):
    parameters = {"n": 2, "restitution": 0.85, "amplitude": [1.1, 0.6], "frequency_ratio": SPAN}
    data = described(frequency_sweep(parameters, "displacement"))
    assert data.amplitude.values.tolist() == [1.1, 0.6]
    assert data.restitution.values.tolist() == [0.85, 0.85]
    # Limits by hand: Eq. 6 and nπ.
    node = 2 * np.pi * 0.15 / 1.85
    assert data.restitution_phase.values == pytest.approx(np.arccos(node / np.array([1.1, 0.6])))
    assert float(data.restitution_bounce_velocity) == 2 * np.pi
    assert float(data.restitution_impact_velocity) == -2 * np.pi
    # At ϖ = 1000 the differences are of order 1/ϖ, with factors of up to 5.
    last = data.isel(frequency_ratio=-1)
    assert last.phase.values == pytest.approx(last.restitution_phase.values, abs=5e-3)
    assert last.bounce_velocity.values == pytest.approx(np.full(2, 2 * np.pi), abs=5e-3)
    assert last.impact_velocity.values == pytest.approx(np.full(2, -2 * np.pi), abs=5e-3)


COMPLIANT = {"frequency_ratio": {"min": 0.1, "max": 0.2, "samples": 3}}


def test_a_figure_without_any_orbit_says_so_in_one_line(refusal):
    cases = CASES | {"cases": CASES["cases"][1:2]} | COMPLIANT
    said = "for any ϖ from 0.1 to 0.2; stiffer contacts, of a larger ϖ, have one"
    with refusal(NoOrbitError, f"nothing to draw: no 1-T orbit at Λ = 1 {said}"):
        apparent_restitution(cases, "displacement")
    sweep = {"n": 2, "restitution": 0.85, "amplitude": [0.6, 1.1]} | COMPLIANT
    for study in (frequency_sweep, typed(poincare_map)):
        with refusal(NoOrbitError, f"nothing to draw: no 2-T orbit at Λ = 0.6, 1.1 {said}"):
            study(sweep, "displacement")


def test_a_curve_without_any_orbit_is_named_as_such():
    sweep = {"n": 1, "restitution": 0.65, "amplitude": [1.0, 900.0]} | COMPLIANT
    data = typed(poincare_map)(sweep, "displacement").assign_attrs(n=1, restitution=0.65)
    assert data.phase.isnull().all("frequency_ratio").values.tolist() == [True, False]
    for draw in (figures.poincare_map, figures.bounce_velocity):
        (legend,) = draw(data).legends
        names = [text.get_text() for text in legend.get_texts()]
        assert [name.endswith("(no orbit)") for name in names][:2] == [True, False]

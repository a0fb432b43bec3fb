"""Measured impacts against every law, and the balls of the experiments on shakers."""

from dataclasses import dataclass

import numpy as np
import pytest
import xarray as xr

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.restitution_by_speed import RestitutionLaw, RestitutionLawModel
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_contacts.contact.units import STANDARD_GRAVITY
from bouncing_ball_contacts.documents import measured_impacts_figures as figures
from bouncing_ball_contacts.documents.measured_impacts import (
    VARIABLES,
    MeasuredImpacts,
    Shaker,
    measured_impacts,
    on_shakers,
)
from bouncing_ball_contacts.measured.curves import CURVES, LawCurve
from bouncing_ball_contacts.measured.experiment import experiment
from bouncing_ball_contacts.measured.verdicts import judge

MEASURED = {"experiments": ["croquet", "plastic_ball", "superball"], "samples": 5}
SHAKER = {
    "experiments": ["croquet", "plastic_ball"],
    "n": [1, 2],
    "frequencies": [5.0, 50.0],
    "position": 0.5,
}


@pytest.fixture(scope="module")
def laws():
    return measured_impacts(MeasuredImpacts(**MEASURED))


@pytest.fixture(scope="module")
def shakers():
    return on_shakers(Shaker(**SHAKER))


def test_the_points_and_curves_are_those_of_the_fits(laws):
    fit = experiment("croquet").fit()
    one = laws.sel(experiment="croquet")
    assert int(one.measured_speed.count()) == 10
    assert sorted(one.experiment_restitution.values.tolist()) == sorted(fit.points.restitutions)
    for name in CURVES:
        law = one.sel(fitted_law=name)
        curve = fit.law(name).restitution_at(one.curve_speed)
        np.testing.assert_array_equal(law.fitted_restitution, curve)
        assert np.all((law.fitted_low <= curve) & (curve <= law.fitted_high))
        assert law.law_verdict.item() == str(judge(fit)[name].verdict)
    # A single point has no band and no verdict.
    single = laws.sel(experiment="superball")
    assert np.isnan(single.fitted_low).all() and single.measured_scatter.isnull().all()
    assert set(single.law_verdict.values) == {"undecided"}


def test_uncertainties_are_those_of_the_experiment_or_of_the_scatter():
    experiments = ["croquet", "membrane_light", "bouncy_ball"]
    data = measured_impacts(MeasuredImpacts(experiments, samples=2))
    given = experiment("membrane_light")
    one = data.sel(experiment="membrane_light")
    found = one.measured_uncertainty.dropna("measured_impact")
    np.testing.assert_allclose(found, given.uncertainties[np.argsort(given.speeds)], rtol=1e-12)
    assert data.errors_given.values.tolist() == [False, True, False]
    size = np.sqrt(np.mean(given.uncertainties**2))
    assert one.errors_size.item() == pytest.approx(size, rel=1e-12)
    # Without uncertainties: the scatter about a parabola, here by another program.
    croquet = data.sel(experiment="croquet")
    assert croquet.measured_uncertainty.isnull().all()
    measured = experiment("croquet")
    x = np.log(measured.speeds)
    smooth = np.polynomial.Polynomial.fit(x, measured.restitutions, 2)
    rest = measured.restitutions - smooth(x)
    scatter = np.sqrt(np.sum(rest**2) / (x.size - 3))
    bars = croquet.measured_scatter.dropna("measured_impact")
    np.testing.assert_allclose(bars, scatter, rtol=1e-6)
    assert croquet.errors_size.item() == pytest.approx(scatter, rel=1e-6)
    # That of heights, which were read to 1 cm, is an error of e as 1/(e v²).
    drops = data.sel(experiment="bouncy_ball")
    ratios = drops.measured_scatter * drops.experiment_restitution * drops.measured_speed**2
    np.testing.assert_allclose(ratios, ratios[0], rtol=1e-12)
    assert drops.scatter_trend > 0.05


def test_the_papers_two_models_are_rows(laws):
    papers = laws.sel(fitted_law=["restitution", "linear"])
    both = papers[["fit_rms", "left_out_rms", "extrapolation_rms"]]
    xr.testing.assert_allclose(
        both.isel(fitted_law=0, drop=True), both.isel(fitted_law=1, drop=True)
    )


def test_the_budgets_allow_what_another_start_of_the_fits_changes(laws, shakers, monkeypatch):
    start = LawCurve.parameter

    def elsewhere(self, restitution):
        return start(self, restitution) * 0.98

    monkeypatch.setattr(LawCurve, "parameter", elsewhere)
    for found, study, given in (
        (laws, measured_impacts, MeasuredImpacts(**MEASURED)),
        (shakers, on_shakers, Shaker(**SHAKER)),
    ):
        again = study(given)
        for name, variable in found.data_vars.items():
            if variable.dtype.kind != "f":
                continue
            budget = VARIABLES[name].budget or 1e-14
            spread = float(variable.max() - variable.min())
            away = float(abs(again[name] - variable).max())
            assert not away > budget * spread / 10, (name, away / spread)


def test_the_impact_speed_on_a_shaker_is_that_of_the_orbit(shakers):
    for one in (shakers.sel(experiment=name) for name in SHAKER["experiments"]):
        unit = STANDARD_GRAVITY / (2 * np.pi * one.shaker_frequency)
        wanted = 2 * np.pi * one.n / (1 + one.shaker_restitution) * unit
        np.testing.assert_allclose(one.shaker_speed, wanted.transpose(*one.shaker_speed.dims))
    croquet = shakers.sel(experiment="croquet")
    assert croquet.shaker_within.values.tolist() == [[True, True], [False, False]]
    # The ball slows as 1/frequency, and is the more elastic for it.
    assert np.all(croquet.shaker_restitution[1] > croquet.shaker_restitution[0])
    assert np.all(croquet.shaker_restitution[:, 0] > croquet.shaker_restitution[:, 1])


@dataclass(frozen=True, repr=False)
class Fitted(RestitutionLaw):
    """r(v) of a fitted law to second order in ln v about a speed, in units of g/Ω."""

    speed: float
    value: float
    trend: float
    curvature: float

    def restitution(self, speed):
        x = np.log(speed / self.speed)
        return self.value + self.trend * x + self.curvature * x**2 / 2


@pytest.mark.parametrize("n", [1, 2])
def test_the_error_by_the_constant_r_is_that_of_orbits_with_r_of_v(shakers, n):
    """Orbits and bifurcations of impacts with r(v), which the library searches for."""
    one = shakers.sel(experiment="croquet", shaker_frequency=5.0)
    fit = experiment("croquet").fit().best
    unit = STANDARD_GRAVITY / (2 * np.pi * 5.0)
    speed = one.shaker_speed.sel(n=n).item()
    step = 1e-3
    below, here, above = (float(fit.restitution_at(speed * np.exp(s * step))) for s in (-1, 0, 1))
    law = Fitted(
        speed / unit, here, (above - below) / (2 * step), (above - 2 * here + below) / step**2
    )
    constant = RestitutionModel(one.shaker_restitution.sel(n=1).item())
    exact = RestitutionLawModel(law)
    found = one.by_constant.sel(n=n)
    for quantity, bifurcation in (
        ("saddle_node", n_t.saddle_node),
        ("period_doubling", n_t.period_doubling),
    ):
        wanted = float(bifurcation(constant, n).amplitude / bifurcation(exact, n).amplitude) - 1
        # The trend by differences is wrong by the square of the step.
        assert found.sel(quantity=quantity).item() == pytest.approx(wanted, abs=1e-6)
    # Half of the way to the period doubling.
    ends = [float(each(exact, n).amplitude) for each in (n_t.saddle_node, n_t.period_doubling)]
    heights = [float(n_t.orbit(each, n, sum(ends) / 2).max_height) for each in (constant, exact)]
    wanted = heights[0] / heights[1] - 1
    assert found.sel(quantity="max_height").item() == pytest.approx(wanted, abs=1e-6)


def test_the_best_constant_r_leaves_all_but_the_period_doubling_of_its_family(shakers):
    first = shakers.by_constant.sel(n=1)
    assert np.all(first.sel(quantity=["saddle_node", "max_height"]) == 0)
    croquet = first.sel(experiment="croquet", quantity="period_doubling")
    assert np.all(croquet < -1e-4)
    second = shakers.by_constant.sel(n=2, experiment="croquet", quantity="saddle_node")
    assert np.all(second < -0.1)


def test_the_error_by_the_duration_is_that_of_orbits_on_the_contact(shakers):
    """Both bifurcation and orbit on a linear contact with the r and contact time of the table."""
    one = shakers.sel(experiment="croquet", shaker_frequency=5.0, n=1)
    r = one.shaker_restitution.item()
    contact = SpringDamper.from_restitution(r, one.shaker_ratio.item(), "displacement")
    exact = float(n_t.saddle_node(ContactModel(contact), 1).amplitude)
    simple = float(n_t.saddle_node(RestitutionModel(r), 1).amplitude)
    error = (exact - simple) / exact
    # The law is that of a Kuwabara-Kono contact, whose σ differs from the linear one by less than
    # half; sign and size agree.
    law = one.by_duration.sel(quantity="saddle_node").item()
    assert np.sign(error) == np.sign(law) and 0.5 < error / law < 2


def test_what_needs_a_contact_time_is_missing_without_one(shakers):
    plastic = shakers.sel(experiment="plastic_ball")
    assert np.isnan(plastic.shaker_ratio).all() and np.isnan(plastic.by_duration).all()
    assert np.isfinite(plastic.by_constant.sel(quantity="saddle_node")).all()


def test_tables_and_figure(laws, shakers):
    head, rows = figures.measured_table(laws)
    # One row for each r(v), and none for an experiment of one impact.
    assert len(rows) == 2 * 3 and all(len(row) == len(head) for row in rows)
    assert {row[head.index("law")] for row in rows} == {
        "constant r",
        "Kuwabara and Kono",
        "Hunt and Crossley",
    }
    head, rows = figures.shaker_table(shakers)
    # The other ball has a constant r and no contact time: nothing can be said of its errors.
    assert [row[0] for row in rows] == ["Croquet ball on wood"] * 2
    assert all(len(row) == len(head) for row in rows)
    law = shakers.shaker_law.where(shakers.shaker_law != "linear", "kuwabara-kono")
    head, rows = figures.shaker_table(shakers.assign(shaker_law=law))
    assert len(rows) == 4 and rows[2][head.index("ϖ")] == "–"
    figure = figures.measured_impacts(laws)
    # Two experiments have several speeds; the third panel of the row is empty.
    assert [axes.axison for axes in figure.axes] == [True, True, False]
    single = laws.measured_speed.count("measured_impact") <= 1
    figure = figures.measured_impacts(laws.isel(experiment=np.flatnonzero(single)))
    assert [text.get_text() for text in figure.axes[0].texts] == [
        "no experiment has several speeds"
    ]


@pytest.mark.parametrize(
    ("study", "given"),
    [
        (measured_impacts, MeasuredImpacts(["nowhere"], samples=5)),
        (on_shakers, Shaker(**SHAKER | {"frequencies": [-1.0]})),
    ],
)
def test_wrong_parameters_are_refused(study, given):
    with pytest.raises(ModelError):
        study(given)


def test_r_by_the_points_is_near_the_points_and_nan_beyond_them(shakers):
    slow, fast = shakers.sel(experiment="croquet", shaker_frequency=[5.0, 50.0]).shaker_measured
    # The speeds are 1.06 and 2.13 m/s: next to 0.842 at 1.00 m/s and 0.824 at 2.04 m/s.
    np.testing.assert_allclose(slow, [0.842, 0.824], atol=2e-3)
    assert fast.isnull().all()
    by_points = shakers.fold_by_points.sel(experiment="croquet", shaker_frequency=5.0)
    first, second = (1 - slow) / (1 + slow)
    np.testing.assert_allclose(by_points, [0.0, float(first / second - 1)], atol=1e-12)

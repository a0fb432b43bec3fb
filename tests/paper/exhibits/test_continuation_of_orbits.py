"""Figures 8, 9, 15 and Table 1: branches by continuation."""

import numpy as np
import pytest

from bouncing_ball.datasets import PERIOD_DOUBLING, SADDLE_NODE
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.permanent_contact import permanent_contact_threshold
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.paper.exhibits.continuation_of_orbits import (
    both_domains,
    orbit_branches,
    stability_ranges,
)
from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import domains
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Bifurcation, Orbit, monodromy
from bouncing_ball.periodic.spring_damper_branch import branch_point
from bouncing_ball.pipeline.job import typed

# As the configuration gives them.
both_domains, orbit_branches, stability_ranges = map(
    typed, (both_domains, orbit_branches, stability_ranges)
)

WINDOW = {"restitution": 0.85, "frequency_ratio": [10.0, 2.0], "amplitude_max": 1.5}
FIGURE_8 = WINDOW | {"n": 1, "points": 61}


def bifurcations(n, r, omega, release="displacement"):
    branch = explicit_branch(SpringDamper(omega, damping_ratio(r), Release(release)))
    return [float(branch.bifurcation(kind, n).amplitude) for kind in Bifurcation]


@pytest.fixture(scope="module")
def figure_8(continuation_settings):
    return orbit_branches(FIGURE_8, "displacement", continuation_settings)


def test_points_are_orbits(figure_8):
    zeta = float(damping_ratio(0.85))
    assert float(figure_8.residual.max()) < 1e-12
    for omega in FIGURE_8["frequency_ratio"]:
        row = figure_8.sel(frequency_ratio=omega)
        orbit = Orbit(
            SpringDamper(omega, zeta),
            1,
            row.amplitude.values,
            row.phase.values,
            row.contact_duration.values,
            row.impact_velocity.values,
        )
        # The explicit formula at the same contact duration: ε carries the
        # rounding of ϖD, and Λ changes by ϖ² over ε.
        excess = row.contact_duration.values * omega * np.sqrt(1 - zeta**2) - np.pi
        point = branch_point(excess, SpringDamper(omega, zeta), 1).orbit
        assert point.amplitude == pytest.approx(row.amplitude.values, abs=1e-12 * (1 + omega**2))
        turn = np.angle(np.exp(1j * (point.phase - row.phase.values)))
        # Next to permanent contact the equations are nearly singular: 1e-9.
        assert np.abs(turn).max() < 1e-9
        end = row.phase.values + row.contact_duration.values
        assert row.release_phase.values == pytest.approx(end, abs=1e-14)
        assert row.bounce_velocity.values == pytest.approx(
            row.impact_velocity.values + 2 * np.pi - row.contact_duration.values, abs=1e-13
        )
        assert row.apparent_restitution.values == pytest.approx(
            orbit.apparent_restitution, rel=1e-12
        )
        # Multipliers and stability from the matrix itself. At the end of the
        # soft branch the impact velocity vanishes, and the map is singular.
        inner = np.abs(orbit.relative_impact_velocity) > 1e-3
        eigenvalues = np.linalg.eigvals(monodromy(orbit))
        largest = np.abs(eigenvalues).max(axis=-1)
        far = inner & (np.abs(largest - 1) > 1e-6)
        assert far.sum() > 50
        assert np.array_equal(row.stable.values[far], largest[far] < 1)
        multipliers = (row.multiplier_real + 1j * row.multiplier_imag).values
        assert np.abs(multipliers[inner][:, 0]) == pytest.approx(largest[inner], rel=1e-6)


def test_branches_start_and_end_where_they_should(figure_8):
    window = "amplitude = 1.5 is reached"
    assert figure_8.end_reason.sel(frequency_ratio=10.0).values.tolist() == [window, window]
    # The soft branch comes from permanent contact, where the impact velocity and the flight vanish.
    start, end = figure_8.end_reason.sel(frequency_ratio=2.0).values.tolist()
    assert start == "the flight vanishes: the orbit merges with permanent contact"
    assert end == window
    threshold = float(permanent_contact_threshold(2.0, damping_ratio(0.85)))
    # Λ is off by the square of the flight left, about 1e-4 there, and some.
    assert float(figure_8.amplitude.sel(frequency_ratio=2.0)[0]) == pytest.approx(
        threshold, abs=1e-6
    )
    assert figure_8.amplitude.sel(frequency_ratio=10.0).values[[0, -1]] == pytest.approx(
        [1.5, 1.5], abs=1e-12
    )
    # The unstable side comes first.
    assert figure_8.phase.values[0, 0] < figure_8.phase.values[0, -1]


def test_the_special_points_are_the_bifurcations(figure_8):
    row = figure_8.sel(frequency_ratio=10.0)
    kinds = [kind for kind in row.special_kind.values.tolist() if kind]
    assert kinds == [SADDLE_NODE, PERIOD_DOUBLING]
    found = row.special_amplitude.values[:2]
    assert found == pytest.approx(bifurcations(1, 0.85, 10.0), abs=1e-12)
    assert np.isnan(row.special_amplitude.values[2:]).all()
    # Two more doublings and one more saddle-node on the soft branch.
    row = figure_8.sel(frequency_ratio=2.0)
    kinds = row.special_kind.values.tolist()
    assert kinds.count(SADDLE_NODE) == 2 and kinds.count(PERIOD_DOUBLING) == 3
    assert float(figure_8.special_residual.max()) < 1e-12
    durations = row.special_contact_duration.values
    assert np.all(np.diff(durations[:5]) < 0)  # in order of the branch


def test_special_points_lie_between_their_neighbours_along_the_branch(figure_8):
    last = figure_8.sizes["point"] - 1
    for ratio in figure_8.frequency_ratio:
        row = figure_8.sel(frequency_ratio=ratio)
        known = row.special_kind.values != ""
        at = row.special_arclength.values[known] * last
        assert np.all(np.diff(at) > 0) and np.all((at > 0) & (at < last))
        before = np.floor(at).astype(int)
        for name in ("phase", "contact_duration"):
            points = row[name].values
            special = row[f"special_{name}"].values[known]
            low = np.minimum(points[before], points[before + 1])
            high = np.maximum(points[before], points[before + 1])
            assert np.all((low <= special) & (special <= high))
        # The stability changes there, and nowhere else.
        changes = np.flatnonzero(np.diff(row.stable.values.astype(int)))
        assert changes.tolist() == before.tolist()


@pytest.mark.slow
def test_the_ends_of_a_stability_range_are_a_saddle_node_and_a_period_doubling(
    continuation_settings, described
):
    # Those of the other release are Table 1 of every run.
    release = "force"
    parameters = WINDOW | {"n": [1, 2], "frequency_ratio": [1e3, 2.0]}
    data = described(stability_ranges(parameters, release, continuation_settings))
    assert data.computed.dims == data.printed.dims == ("frequency_ratio", "n", "bound")
    assert data.bound.values.tolist() == [SADDLE_NODE, PERIOD_DOUBLING]
    for omega in (1e3, 2.0):
        for n in (1, 2):
            found = data.computed.sel(frequency_ratio=omega, n=n).values
            assert found == pytest.approx(bifurcations(n, 0.85, omega, release), abs=1e-12)
    assert data.printed.sel(frequency_ratio=2.0).values.tolist() == [[0.187, 1.082], [0.463, 1.170]]
    assert np.isnan(data.printed.sel(frequency_ratio=1e3)).all()
    limit = data.restitution_range.sel(impact_map="exact").values
    assert limit == pytest.approx(np.array([[0.2547, 1.0383], [0.5094, 1.1281]]), abs=6e-5)


def test_fig_15_has_the_branches_of_both_models(continuation_settings, described):
    parameters = {
        "n": 2,
        "restitution": 0.65,
        "frequency_ratio": 10.0,
        "amplitude_max": 2.2,
        "points": 41,
    }
    data = described(both_domains(parameters, "displacement", continuation_settings))
    assert data.amplitude.shape == (1, 41) and data.restitution_amplitude.shape == (41,)
    node = 2 * np.pi * 0.35 / 1.65
    assert float(data.saddle_node_amplitude) == pytest.approx(node, rel=1e-14)
    along = data.restitution_amplitude.values * np.cos(data.restitution_phase.values)
    assert along == pytest.approx(np.full(41, node), rel=1e-13)
    doubling = float(data.period_doubling_amplitude)
    inside = (data.restitution_phase > 0) & (data.restitution_amplitude < doubling)
    assert np.array_equal(data.restitution_stable.values, inside.values)
    assert doubling * np.sin(float(data.period_doubling_phase)) == pytest.approx(
        2 * (1 + 0.65**2) / 1.65**2, rel=1e-12
    )


def test_a_very_stiff_contact_is_stable_between_its_bifurcations(continuation_settings):
    parameters = WINDOW | {"n": [1], "frequency_ratio": [1e5], "amplitude_max": 1.2}
    data = stability_ranges(parameters, "displacement", continuation_settings)
    assert data.computed.values.ravel() == pytest.approx(bifurcations(1, 0.85, 1e5), abs=1e-12)


def test_figure_8_has_the_branches_of_the_paper_and_names_what_it_marks(figure_8):
    data = figure_8.assign_attrs(n=1, restitution=0.85, amplitude_max=1.5)
    figure = domains(data)
    (legend,) = figure.legends
    names = {text.get_text() for text in legend.get_texts()}
    assert names - {"", r"$\varpi=10$", r"$\varpi=2$"} == {
        "stable",
        "unstable",
        SADDLE_NODE,
        PERIOD_DOUBLING,
    }
    drawn = np.concatenate([line.get_xdata() for line in figure.axes[0].lines])
    assert np.isin(data.amplitude.values, drawn).all()
    assert [len(axes.child_axes) for axes in figure.axes] == [0, 0]


@pytest.mark.parametrize("release", ["displacement", "force"])
def test_branches_under_each_release_are_those_of_the_closed_form(continuation_settings, release):
    parameters = FIGURE_8 | {"frequency_ratio": [10.0], "points": 21}
    data = orbit_branches(parameters, release, continuation_settings).squeeze()
    contact = SpringDamper(10.0, damping_ratio(0.85), Release(release))
    excess = data.contact_duration.values * contact.damped_frequency - contact.free_angle
    found = branch_point(excess, contact, 1).orbit
    assert found.amplitude == pytest.approx(data.amplitude.values, abs=1e-10)


def test_a_branch_that_does_not_exist_is_missing_and_says_why(continuation_settings):
    parameters = FIGURE_8 | {"frequency_ratio": [10.0, 0.6], "points": 11}
    data = orbit_branches(parameters, "displacement", continuation_settings)
    assert np.isfinite(data.amplitude[0]).all() and np.isnan(data.amplitude[1]).all()
    assert not data.stable[1].any() and not data.admissible[1].any()
    assert all(
        "no 1-T orbit up to Λ = 1.5 for ϖ = 0.6" in str(reason)
        for reason in data.end_reason[1].values
    )


def test_branches_of_which_none_exists_are_refused_with_the_reason(refusal, continuation_settings):
    parameters = FIGURE_8 | {"frequency_ratio": [0.1], "points": 11}
    with refusal(NoOrbitError, "nothing to draw: no 1-T orbit up to Λ = 1.5 for ϖ = 0.1"):
        orbit_branches(parameters, "displacement", continuation_settings)


def test_the_figure_has_the_reason_for_a_branch_that_is_missing(continuation_settings):
    parameters = FIGURE_8 | {"frequency_ratio": [10.0, 0.6], "points": 11}
    data = orbit_branches(parameters, "displacement", continuation_settings)
    attributes = {"n": 1, "restitution": 0.85, "amplitude_max": 1.5}
    title = domains(data.assign_attrs(attributes)).get_suptitle()
    assert title.count("no 1-T orbit up to Λ = 1.5 for ϖ = 0.6") == 1


def test_a_window_without_a_period_doubling_has_no_range_and_says_why(continuation_settings):
    parameters = WINDOW | {"n": [1], "frequency_ratio": [10.0], "amplitude_max": 0.9}
    data = stability_ranges(parameters, "displacement", continuation_settings)
    assert np.isnan(data.computed).all()
    why = str(data.absence[0, 0].item())
    assert "no period doubling" in why and "amplitude = 0.9 is reached" in why


def test_a_branch_without_a_saddle_node_has_no_range_and_says_why(continuation_settings):
    parameters = WINDOW | {"n": [1], "frequency_ratio": [1.0]}
    data = stability_ranges(parameters, "displacement", continuation_settings)
    assert np.isnan(data.computed).all() and "no saddle-node" in str(data.absence[0, 0].item())

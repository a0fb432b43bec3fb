"""Maps of the motions on which balls end, against orbits and a changed rounding."""

import numpy as np
from declared_artifacts import compare_artifact
from matplotlib.figure import Figure

from bouncing_ball.beyond.exhibits.locking import GROUPS, agreement, locking
from bouncing_ball.beyond.exhibits.motion_maps import stacked_shares
from bouncing_ball.beyond.exhibits.motion_samples import three_models
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Kind, Motions
from bouncing_ball.models.damping import Release
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.pipeline.configuration import typed

START = {"phase": 1.0, "impact_speed": 10.0, "impacts": 200, "further": 400}
START |= {"resolved_impacts": 400, "confidence": 0.95}


def study(ratio, lam, r, **changed):
    """The map of a few nodes; ends and number of amplitudes and restitution coefficients."""
    grids = ({"min": x[0], "max": x[1], "samples": x[2]} for x in (lam, r))
    given = dict(zip(("amplitude", "restitution"), grids, strict=True)) | START | changed
    return typed(locking)(given | {"frequency_ratio": [ratio]}, Release.DISPLACEMENT)


def test_exponents_of_orbits_are_those_of_their_multipliers():
    data = study(100.0, (2.2, 2.4, 3), (0.2, 0.25, 2))
    models = three_models(data.restitution.values[:, None], 100.0, Release.DISPLACEMENT)
    for model, name in zip(models, data["model"].values, strict=True):
        one = data.sel(model=name)
        orbit = n_t.orbit(model, 1, data["amplitude"].values)
        larger = np.abs(orbit.multipliers()).max(axis=-1)
        there = ((one.kind == "orbit") & (one.periods == 1) & (one.impacts == 1)).values
        assert there.any() and np.all(larger[there] < 1)
        exponent = one.lyapunov_exponent.values[there]
        assert np.allclose(exponent, np.log(larger[there]), atol=one.lyapunov_error.values.min())
        # The sum of both exponents is that of the area.
        assert np.all(exponent >= np.log(orbit.determinant()[there]) / 2 - 1e-5)


def test_a_model_agrees_with_itself_wherever_its_motion_is_known():
    balls = final_motions(RestitutionModel(0.5), np.linspace(1.2, 3.2, 9), 1.0, -9.0, impacts=300)
    nodes, low, high = agreement(balls, balls)
    there = np.isfinite(low)
    known = (balls.kind != "undecided") & ~balls.is_unresolved()
    assert nodes[GROUPS.index("all")] == np.sum(known) and there.any()
    assert low[GROUPS.index("all")] == known.mean() and np.all(high[there] == 1)


def test_what_is_not_known_lies_between_the_bounds_of_a_share():
    """A chaotic contact disagrees with every locked ball; two unknown periods decide nothing."""
    simple = Motions.unknown(5)
    simple.fill(np.arange(5), kind=Kind.LOCKED, periods=[0, 0, 2, 2, 20])
    contact = Motions.unknown(5)
    kinds = [Kind.CHAOTIC, *[Kind.LOCKED] * 3, Kind.UNDECIDED]
    contact.fill(np.arange(5), kind=kinds, periods=[0, 3, 0, 2, 0])
    found = dict(zip(GROUPS, agreement(simple, contact).T.tolist(), strict=True))
    assert found["locked"] == [2, 1 / 5, 4 / 5]
    assert found["locked, 1 to 4 T"] == [1, 1 / 2, 1]
    assert found["locked, unknown period"] == [1, 0, 1 / 2]
    # The long periods are the one known and the two unknown ones.
    assert found["locked, above 10 T"] == [1, 0, 2 / 3]
    assert np.isnan(found["orbit"][1:]).all()


def test_the_bars_of_a_group_fill_the_whole_of_its_nodes(recorded):
    """From below the lower bound of the share that agrees, and what is not known above it."""
    data = recorded["ext_locking"]
    figure = Figure()
    stacked_shares(figure, data, {"locked, above 10 T": "above 10 T"}, "{}")
    axes = figure.axes[0]
    one = data.sel(simple="restitution", motion_group="locked, above 10 T")
    same, unknown, other = (
        np.array([[bar.get_y(), bar.get_height()] for bar in bars]).T for bars in axes.containers
    )
    assert np.array_equal(same[1], one.agreement_low)
    assert np.allclose(unknown.sum(axis=0), one.agreement_high, rtol=0, atol=1e-15)
    assert np.allclose(other.sum(axis=0), 1, rtol=0, atol=1e-15)


def test_rounding_may_decide_at_few_nodes_only(recorded):
    """A change of 1e-15 in the start changes kinds at 1.4 % of the nodes."""
    record = recorded["ext_locking"]
    last = record.kind.size // record.sizes["restitution"]
    for rows, allowed in ((1, True), (5, False)):
        new = record.copy(deep=True)
        assert rows * last <= 0.05 * record.kind.size or not allowed
        new.kind[:, :rows] = "another"
        names = {
            x.name for x in compare_artifact("ext_locking", record, new) if not x.outcome.agrees
        }
        assert names == (set() if allowed else {"kind"})


def test_many_digits_tell_periods_where_doubles_do_not():
    """At r = 0.55: what doubles know is kept, and most of what they do not is a period above 10."""
    data = study(1000.0, (2.6, 3.6, 9), (0.55, 0.6, 2))
    r, lam = (x.ravel() for x in np.meshgrid(data.restitution, data.amplitude, indexing="ij"))
    velocity = lam * np.cos(START["phase"]) - START["impact_speed"]
    balls = final_motions(RestitutionModel(r), lam, START["phase"], velocity, impacts=200)
    periods = data.periods.sel(model="restitution").values.ravel()
    unresolved = balls.is_unresolved()
    assert np.array_equal(periods[~unresolved], balls.periods[~unresolved])
    found = periods[unresolved]
    assert data.many_digits_nodes == (found > 0).sum() > 3
    assert found[found > 0].min() > 10
    rigid = data.kind_nodes.sel(model="restitution", motion_group="locked, unknown period")
    assert rigid.values.tolist() == [(found == 0).sum()]


def test_a_contact_may_be_chaotic_where_the_restitution_model_locks():
    """At r = 0.7 on a compliant contact, ball by ball, also those that have stuck twice."""
    data = study(100.0, (2.5, 4.5, 21), (0.7, 0.71, 2), impacts=200, further=400)
    r, lam = (x.ravel() for x in np.meshgrid(data.restitution, data.amplitude, indexing="ij"))
    velocity = lam * np.cos(START["phase"]) - START["impact_speed"]
    contact, simple = (
        final_motions(model, lam, START["phase"], velocity, impacts=200)
        for model in three_models(r, 100.0, Release.DISPLACEMENT)[::-2]
    )
    both = (simple.kind == "locked") & (contact.kind == "chaotic")
    assert both.sum() == data.chaotic_nodes[0] > 5
    sticks = (contact.times_stuck > 1) & both
    assert 0 < sticks.sum() == data.chaotic_sticking_nodes[0] < both.sum()
    assert 0 < data.lasting_nodes[0] <= both.sum()

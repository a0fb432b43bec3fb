"""The verdicts on the claims of the paper, of the datasets of the reference and of altered ones."""

import csv
import importlib
import io
from dataclasses import replace
from operator import attrgetter
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq
from tests import independent
from tests.reference import ENTRIES, with_more, with_parameters
from tests.reference import reference as every_dataset

from bouncing_ball import restitution
from bouncing_ball.spring_damper import damping_ratio, permanent_contact
from carbonelli2011 import claims, measures, paper
from carbonelli2011.paper import printed_table
from paper_replication import judgements, texts
from paper_replication.datasets import other_parameters, parameters
from paper_replication.verdicts import answer

ROOT = Path(__file__).parents[1]
PRINTED = printed_table()
DATASETS = {name for claim in claims.CLAIMS for name in claim.datasets} | {*paper.PARAMETERS}
NAMES = sorted(DATASETS & ENTRIES.keys())


@pytest.fixture(scope="module")
def reference():
    """The datasets of the reference that claims use, by name, with the curves of the paper."""
    return paper.of_paper({name: every_dataset()[name] for name in NAMES})


@pytest.fixture(scope="module")
def judged(reference):
    return claims.judge(reference)


def verdicts(data):
    """Verdicts by claim."""
    return dict(zip(data["claim"].values.tolist(), data["verdict"].values.tolist(), strict=True))


EVERY = {claim.name: claim for claim in [*claims.CLAIMS, *claims.table1_ends()]}


def verdict(name, datasets):
    """The verdict on one claim."""
    return answer(EVERY[name], datasets)["verdict"]


def users(name):
    """The claims that a dataset decides."""
    return [claim for claim in EVERY.values() if name in claim.datasets]


def with_other(reference, name, **variables):
    """The datasets, with variables of one of them replaced."""
    return reference | {name: reference[name].assign(variables)}


def scaled(reference, name, variable, factor):
    return with_other(reference, name, **{variable: reference[name][variable] * factor})


def test_claims_rest_on_datasets_of_the_configuration():
    assert DATASETS <= ENTRIES.keys()


# Printed numbers


def test_each_end_of_table_1_is_one_claim_with_its_printed_digits():
    ends = claims.table1_ends()
    assert len(ends) == 18
    printed = {end.name: end.printed for end in ends}
    assert printed["Table 1: 10, 3, saddle-node"] == "0.750"
    assert printed["Table 1: 2, 2, period doubling"] == "1.170"
    assert all(len(text.partition(".")[2]) == 3 for text in printed.values())


def test_the_printed_table_of_the_dataset_is_that_of_the_paper(reference):
    """Whatever further rows the dataset has."""
    printed = reference["table1"]["printed"].dropna("frequency_ratio")
    xr.testing.assert_equal(printed, PRINTED.astype(float))


def test_numbers_that_are_those_of_the_paper_are_reproduced(reference):
    same = with_other(reference, "table1", computed=reference["table1"]["printed"])
    ends = [verdict(end.name, same) for end in claims.table1_ends()]
    assert ends == ["reproduced"] * 18


@pytest.mark.parametrize("place", [0, 1, -1])
def test_a_further_curve_or_row_changes_no_claim(reference, judged, place):
    more = {
        name: with_more(data, paper.PARAMETERS.get(name, {}), place)
        for name, data in reference.items()
    }
    xr.testing.assert_identical(claims.judge(more), judged)


def test_a_changed_number_changes_its_verdict_alone(reference, judged):
    changed = with_other(reference, "fig14", error_threshold=xr.DataArray(82.7))
    expected = verdicts(judged) | {"height threshold": "not reproduced"}
    assert verdicts(claims.judge(changed)) == expected


# Statements


# Numbers of the readings, to three digits: those that hold, and those that do not.
def test_the_numbers_of_statements_are_those_of_formulas_of_their_own(reference, judged):
    """The number of the paper's own sentence, of statements that the article does not explain."""
    fig06, fig10, fig15 = (reference[name] for name in ("fig06", "fig10", "fig15"))
    fig13 = reference["fig13"].isel(case=0, frequency_ratio=-1)
    velocity = fig10["bounce_velocity"] / (2 * np.pi)
    ends = reference["table1"]["computed"].sel(frequency_ratio=[1e4, 10.0, 2.0])
    node = ends.sel(frequency_ratio=[10.0, 2.0], bound="saddle-node")
    rigid = np.array([1, 2, 3]) * np.pi * 0.15 / 1.85
    limit = np.arccos(np.pi * 0.35 / 1.65)
    special = fig15["special_amplitude"].where(fig15["special_kind"] == "saddle-node").max()
    expected = {
        "contact lengthens": min(
            -reference[name]["contact_duration"].diff("frequency_ratio").max()
            for name in ("fig05", "fig06", "fig10")
        ),
        "depends on amplitude": np.ptp(fig06["apparent_restitution"].values, axis=0).max(),
        "no longer nπ": (1 - velocity).min(),
        "phases converge": max(abs(fig13["phase"] - limit), abs(fig13["release_phase"] - limit))
        / (2 * np.pi),
        "range widens": np.diff(np.diff(ends.values)[..., 0], axis=0).min(),
        "stiff limit": reference["thresholds"]["relative_error"].isel(frequency_ratio=-1).max(),
        "representative": abs(special / (2 * np.pi * 0.35 / 1.65) - 1),
        "existence changes": abs(node / rigid - 1).min(),
        "moving table": max(
            abs(data["apparent_restitution"] / data["restitution"] - 1).max()
            for data in (reference["fig05"], fig06)
        ),
    }
    numbers = {name: float(judged["found"].sel(claim=name)) for name in expected}
    assert numbers == pytest.approx({name: float(value) for name, value in expected.items()})


# What changes in a dataset, and the verdict that it must change.
CHANGES = {
    "stiff limit": ("thresholds", "relative_error", 200.0, "partly"),
    "contact lengthens": ("fig10", "contact_duration", -1.0, "not reproduced"),
    "superimposed when stiff": ("fig08", "contact_duration", 100.0, "not reproduced"),
    "range widens": ("table1", "computed", -1.0, "partly"),
    "velocity rises": ("fig05", "bounce_velocity", -1.0, "partly"),
    "phases converge": ("fig06", "phase", 1.1, "partly"),
    "high flights": ("fig05", "max_height", 0.1, "not reproduced"),
    "dip at 1.2": ("fig06", "apparent_restitution", 0.99, "reproduced"),
    "negligible above 100": ("fig06", "apparent_restitution", 1.1, "not reproduced"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_a_statement_changes_with_the_number_that_decides_it(reference, name):
    dataset, variable, factor, expected = CHANGES[name]
    changed = scaled(reference, dataset, variable, factor)
    assert verdict(name, changed) == expected


@pytest.mark.parametrize("figure", claims.CURVES.split())
def test_a_sense_of_every_curve_is_asked_of_each(reference, figure):
    """One curve that turns round along ϖ contradicts it."""
    data = reference[figure]
    last = data["case"] == data["case"][-1]
    changed = with_other(
        reference,
        figure,
        **{
            name: data[name].where(~last, data[name].values[:, ::-1])
            for name in ("phase", "contact_duration", "bounce_velocity", "apparent_restitution")
        },
    )
    for name in (
        "stiff limit",
        "compliant divergence",
        "contact lengthens",
        "closer with stiffness",
        "velocity rises",
        "phases converge",
    ):
        for datasets, holds in ((reference, True), (changed, False)):
            readings = EVERY[name].decide(*(datasets[dataset] for dataset in EVERY[name].datasets))
            assert readings[-1].holds == holds


@pytest.mark.parametrize("name", ["height rises", "threshold ensures"])
def test_the_curve_of_the_smallest_r_alone_contradicts_what_heights_do(reference, name):
    datasets = [reference[dataset] for dataset in EVERY[name].datasets]
    others = [data.isel(case=slice(3)) if "case" in data.dims else data for data in datasets]
    assert [reading.holds for reading in EVERY[name].decide(*others)][-1]
    assert answer(EVERY[name], reference)["own_sense"] == "holds"


def test_models_that_agree_contradict_what_the_paper_says_of_their_differences(reference):
    rigid = reference["table1"]["restitution_range"].sel(impact_map="exact", drop=True)
    table1, fig15, validity_map = (reference[name] for name in ("table1", "fig15", "validity_map"))
    kind = fig15["special_kind"]
    ends = fig15["saddle_node_amplitude"].where(
        kind == "saddle-node", fig15["period_doubling_amplitude"]
    )
    same = {
        "table1": table1.assign(computed=rigid.broadcast_like(table1["computed"])),
        "fig15": fig15.assign(special_amplitude=ends.where(kind != "")),
        "validity_map": validity_map.assign(below_share=validity_map["doubled_share"]),
    }
    for name, n in (("fig05", 1), ("fig06", 1), ("fig10", 2)):
        curves = reference[name]
        same[name] = curves.assign(
            apparent_restitution=curves["restitution"].broadcast_like(curves["phase"]),
            bounce_velocity=xr.full_like(curves["phase"], n * np.pi),
        )
    others = reference | same
    for claim in (
        "existence changes",
        "bifurcations move apart",
        "range widens",
        "no longer nπ",
        "depends on amplitude",
        "dip at 1.2",
    ):
        assert verdict(claim, others) == "not reproduced"
    for claim in ("negligible above 100", "closer with stiffness", "amplitude does not matter"):
        assert verdict(claim, others) == "reproduced"
    # A table at rest has another restitution than r, because of the weight.
    assert answer(EVERY["moving table"], others)["own_sense"] == "does not hold"


def test_a_moving_table_like_one_at_rest_is_no_reason_for_another_restitution(reference):
    """Eq. 16 fails then because of the weight, and not because the table moves."""
    # A tenth of the frequency ratios is enough.
    fig06 = reference["fig06"].isel(frequency_ratio=slice(None, None, 10))
    curves = fig06["apparent_restitution"]
    at_rest = [measures.restitution_at_rest(0.65, ratio) for ratio in curves.frequency_ratio.values]
    still = xr.zeros_like(curves) + xr.DataArray(at_rest, dims="frequency_ratio")
    changed = reference | {"fig06": fig06.assign(apparent_restitution=still)}
    judgement = answer(EVERY["moving table"], changed)
    assert (judgement["verdict"], judgement["own_sense"]) == ("partly", "holds")


def test_the_end_of_a_curve_is_that_of_the_curve_of_the_largest_amplitude(reference):
    name = "compliant end of 1.2"
    curves = reference["fig06"]["apparent_restitution"]
    largest = curves["amplitude"] == 1.2
    others = with_other(reference, "fig06", apparent_restitution=curves.where(largest, 0.84))
    assert verdict(name, others) == verdict(name, reference)
    changed = with_other(reference, "fig06", apparent_restitution=curves.where(~largest, 0.84))
    assert verdict(name, changed) == "not reproduced"


@pytest.mark.parametrize(
    ("begins", "literal", "seen"),
    [(27, 0, 1), (49, 0, 1), (51, 1, 0), (140, 1, 0), (151, 0, 0)],
)
def test_a_departure_begins_where_it_is_printed(reference, begins, literal, seen):
    """By 1 % at a given ϖ, and by a line, 1 % of a third of nπ, at three times that ϖ."""
    fig10 = reference["fig10"]
    ratio = fig10["frequency_ratio"]
    size = (0.01 * begins / ratio).clip(max=1 / 3).broadcast_like(fig10["bounce_velocity"])
    velocity = (1 - size) * fig10["restitution_bounce_velocity"]
    decided = EVERY["departure from nπ"].decide
    readings = decided(fig10.assign(bounce_velocity=velocity), reference["validity_map"])
    assert [reading.holds for reading in readings] == [literal, seen, False]
    assert readings[0].found == pytest.approx(begins, rel=1e-6)


def test_an_orbit_that_is_not_admissible_has_no_one_impact(reference):
    admissible = reference["fig15"]["admissible"].copy()
    admissible[0, 0] = False
    changed = with_other(reference, "fig15", admissible=admissible)
    assert verdict("one impact per period", changed) == "not reproduced"


@pytest.mark.parametrize(("impacts", "periods"), [((2, 2), (2, 2)), ((1, 2), (1, 1))])
def test_a_motion_of_one_kind_is_not_one_of_another(reference, impacts, periods):
    """Two subharmonic balls are not periodic, and two impacts in one period not subharmonic."""
    balls = reference["three_balls"].sortby("impacts")
    chaotic = balls["impacts"].values == 0
    assert chaotic.sum() == 1
    counts = balls["impacts"].copy(data=[0, *impacts])
    lengths = balls["periods"].copy(data=[0, *periods])
    changed = with_other(
        reference | {"three_balls": balls}, "three_balls", impacts=counts, periods=lengths
    )
    assert verdict("kinds of motion", reference) == "reproduced"
    assert verdict("kinds of motion", changed) == "not reproduced"


def test_a_ball_that_sticks_is_not_chaotic(reference):
    stickings = reference["three_balls"]["stickings"] + 1
    changed = with_other(reference, "three_balls", stickings=stickings)
    assert verdict("kinds of motion", changed) == "not reproduced"


@pytest.mark.parametrize(("errors", "expected"), [(5.5, "reproduced"), (4.5, "not reproduced")])
def test_a_ball_is_chaotic_if_its_exponent_is_positive_by_five_standard_errors(
    reference, errors, expected
):
    exponent = reference["three_balls"]["lyapunov_exponent"]
    changed = with_other(reference, "three_balls", lyapunov_error=exponent / errors)
    assert verdict("kinds of motion", changed) == expected


def test_a_range_that_is_not_stable_breaks_the_rule(reference, judged):
    name = "stable between"
    assert judged["own_sense"].sel(claim=name) == "holds"
    stable = reference["fig09"]["stable"] & False
    changed = with_other(reference, "fig09", stable=stable)
    assert verdict(name, changed) == "not reproduced"


def test_a_dip_that_cannot_be_seen_is_none(reference):
    curves = reference["fig06"]["apparent_restitution"]
    line = claims.line_width(curves)
    assert line == pytest.approx(0.01 * float(curves.max() - curves.min()))
    for depth, expected in ((0.9, "not reproduced"), (1.1, "reproduced")):
        there = (curves["amplitude"] == 1.2) & (curves["frequency_ratio"] == 10.0)
        dipping = curves.where(~there, 0.65 - depth * line)
        changed = with_other(reference, "fig06", apparent_restitution=dipping)
        assert verdict("dip at 1.2", changed) == expected


def test_an_orbit_that_does_not_exist_is_not_inadmissible(reference):
    data = reference["fig15"]
    exists = xr.DataArray(np.arange(data.sizes["point"]) > 3, dims="point")
    changed = with_other(
        reference,
        "fig15",
        phase=data["phase"].where(exists),
        admissible=data["admissible"] & exists,
    )
    assert verdict("one impact per period", changed) == "reproduced"


def test_crossings_lie_between_the_points_of_a_dataset():
    ratio = np.geomspace(1, 100, 21)
    curve = xr.DataArray(1 / ratio, {"frequency_ratio": ratio}, ("frequency_ratio",))
    # Its error is some 1e-4 on a grid of steps of 1.26.
    assert measures.crossing(curve, 0.3) == pytest.approx(1 / 0.3, rel=1e-3)
    assert np.isnan(measures.crossing(curve, 2.0))


def test_amplitudes_matter_below_the_frequency_ratio_that_an_own_computation_finds(reference):
    """At the crossing the three orbits are computed again, from the closed form."""
    fig10 = reference["fig10"]
    ratio = measures.crossing(measures.spread(fig10), 0.01)
    zeta = independent.restitution_to_damping(0.85)
    velocities = []
    for curve in fig10["contact_duration"]:
        amplitude = curve["amplitude"].item()
        near = float(curve.interp(frequency_ratio=ratio))
        duration = brentq(
            lambda time, size=amplitude: (
                independent.orbit(2, ratio, zeta, "displacement", time)[0] - size
            ),
            near - 1e-3,
            near + 1e-3,
        )
        impact = independent.orbit(2, ratio, zeta, "displacement", duration)[2]
        velocities.append(impact + 4 * np.pi - duration)
    assert np.ptp(velocities) / (2 * np.pi) == pytest.approx(0.01, rel=1e-4)


def test_what_holds_by_algebra_follows_from_the_formulas():
    zeta = damping_ratio(0.65)
    r = 10.0 ** -np.arange(1, 301)
    lack = 1 - damping_ratio(r)
    assert (lack > 0).all()
    # The next term of the series is smaller by 3π²/(4 ln²r).
    assert lack[-1] * 2 * np.log(r[-1]) ** 2 / np.pi**2 == pytest.approx(1, abs=1e-4)
    assert damping_ratio(1.0) == 0
    assert permanent_contact(1e4, zeta) == pytest.approx(1, abs=1e-8)
    assert permanent_contact(1e-4, zeta) == pytest.approx(1e8, rel=1e-8)
    assert permanent_contact(1.0, zeta) == pytest.approx(2 * zeta, abs=1e-12)
    ratio = np.geomspace(0.1, 100, 2001)
    lowest = permanent_contact(ratio, zeta).min() - 2 * zeta * np.sqrt(1 - zeta**2)
    # It is a minimum, so that a grid misses it by the square of its step, 3.5e-3.
    assert 0 <= lowest < 1e-4
    for n in (1, 2, 3):
        assert restitution.impact_phase(n, 0.65, restitution.saddle_node(n, 0.65)) == 0
        assert restitution.trace(0.65, 0.0) == pytest.approx(1 + 0.65**2)


def test_a_ball_without_weight_bounces_from_a_table_at_rest_with_r():
    assert measures.restitution_at_rest(0.3, 5.0, weight=0.0) == pytest.approx(0.3, abs=1e-12)
    # To first order in the weight, r falls by 2ζ(1 + r)/(πϖ): corrections are of the order of 1/ϖ².
    for ratio in (1e2, 1e3):
        lost = 0.65 - measures.restitution_at_rest(0.65, ratio)
        expected = 2 * damping_ratio(0.65) * 1.65 / (np.pi * ratio)
        assert lost == pytest.approx(expected, rel=3 / ratio)


# What is missing, and other parameters


def test_a_claim_reads_the_datasets_that_decide_it_and_no_other(reference, judged):
    alone = {}
    for claim in EVERY.values():
        own = {name: reference[name] for name in claim.datasets}
        alone[claim.name] = answer(claim, own)["verdict"]
    assert alone == {name: verdicts(judged)[name] for name in EVERY}


@pytest.mark.parametrize("name", NAMES)
def test_a_missing_dataset_takes_away_its_claims(reference, name):
    rest = {key: data for key, data in reference.items() if key != name}
    assert {verdict(claim.name, rest) for claim in users(name)} <= {"not asked"}


@pytest.mark.parametrize("name", NAMES)
def test_numbers_that_are_missing_take_away_their_claims(reference, name):
    data = reference[name]
    computed = [variable for variable, values in data.items() if values.dtype.kind == "f"]
    lost = {variable: data[variable] * np.nan for variable in computed if variable != "printed"}
    datasets = with_other(reference, name, **lost)
    for claim in users(name):
        decided = claim.datasets == claims.CONTACT_OF_FIG11
        assert verdict(claim.name, datasets) == ("reproduced" if decided else "not asked")


@pytest.mark.parametrize(
    ("name", "variable", "claim"),
    [
        ("fig05", "apparent_restitution", "moving table"),
        ("fig05", "contact_duration", "contact lengthens"),
        ("fig05", "max_height", "safe above 100"),
        ("fig06", "apparent_restitution", "depends on amplitude"),
        ("fig08", "contact_duration", "apart when compliant"),
        ("fig08", "phase", "table velocities"),
        ("fig10", "bounce_velocity", "amplitude does not matter"),
        ("fig12", "ball", "height rises"),
        ("lowest_doubling", "period_doubling_turn", "bifurcations move apart"),
        ("thresholds", "relative_error", "compliant divergence"),
        ("three_balls", "lyapunov_exponent", "kinds of motion"),
    ],
)
def test_one_number_that_is_missing_is_enough(reference, name, variable, claim):
    data = reference[name][variable]
    values = data.values.copy()
    # A motion that is periodic needs no exponent, and the last one is chaotic; the last contact is
    # stiff.
    place = -1 if name == "three_balls" or claim == "safe above 100" else values.size // 2
    values.ravel()[place] = np.nan
    assert verdict(claim, with_other(reference, name, **{variable: data.copy(data=values)})) == (
        "not asked"
    )


@pytest.mark.parametrize("name", sorted(paper.PARAMETERS))
def test_claims_under_other_parameters_are_not_asked(reference, name):
    data = reference[name]
    assert not other_parameters(name, data, paper.PARAMETERS[name])
    for key, needed in paper.PARAMETERS[name].items():
        other = {"min": 0.7, "max": 70.0} if isinstance(needed, dict) else [0.7]
        changed = with_parameters(data, **{key: other})
        said = other_parameters(name, changed, paper.PARAMETERS[name])
        assert said.startswith(f"{name}.{key}")
    for claim in users(name):
        judgement = answer(claim, reference | {name: changed})
        assert judgement["verdict"] == "not asked"
        assert f"{name}.{key}" in judgement["reason"]


def test_parameters_on_which_no_claim_rests_may_be_others(reference, judged):
    other = parameters(reference["fig14"])["frequency_ratio"] | {"samples": 77}
    changed = with_parameters(reference["fig14"], frequency_ratio=other, tolerance=0.02)
    for claim in users("fig14"):
        new_verdict = verdict(claim.name, reference | {"fig14": changed})
        # Only the threshold of ϖ depends on the tolerance.
        silent = claim.name == "height threshold"
        assert new_verdict == ("not asked" if silent else verdicts(judged)[claim.name])


# Formulas that no other module tests


@pytest.mark.parametrize(("n", "r"), [(1, 0.85), (2, 0.65), (3, 0.2)])
def test_equation_8_is_the_doubling_of_the_map_whose_flights_end_at_their_height(n, r):
    amplitude = restitution.holmes_period_doubling(n, r)

    def reduced_map(phase, velocity):
        landing = phase + 2 * velocity
        return np.array([landing, r * velocity + (1 + r) * amplitude * np.cos(landing)])

    orbit = np.array([restitution.impact_phase(n, r, amplitude), n * np.pi])
    assert reduced_map(*orbit) == pytest.approx([orbit[0] + 2 * n * np.pi, orbit[1]], abs=1e-12)
    step = 1e-5
    columns = [
        (reduced_map(*(orbit + change)) - reduced_map(*(orbit - change))) / (2 * step)
        for change in step * np.eye(2)
    ]
    # Central differences are off by the third derivative, some ten, times the square of the step.
    assert min(np.linalg.eigvals(np.transpose(columns)).real) == pytest.approx(-1, abs=1e-8)


# Claims of one's own


def test_a_claim_of_ones_own_changes_no_count_and_one_that_raises_is_named(judged, reference):
    own = [replace(EVERY["range widens"], name="mine", place="")]
    wrong = replace(EVERY["dip at 1.2"], decide=lambda fig06: fig06["height"])
    rest = [claim for name, claim in EVERY.items() if name != wrong.name]
    with_own = judgements.judged(reference, [*rest, wrong, *own], [], "")
    assert with_own["group"].sel(claim="mine") == "own claim"
    assert with_own["verdict"].sel(claim="mine") == "reproduced"
    (line,) = judgements.raised(with_own)
    assert line.startswith("dip at 1.2 is not asked, its function <lambda> raises KeyError")
    assert "\n## Own claims\n" in judgements.claims_markdown(with_own, "", "Table 1")
    expected = judgements.counts(judged)
    expected["statement"]["not reproduced"] -= 1
    expected["statement"]["not asked"] += 1
    assert judgements.counts(with_own) == expected


# All claims


def test_algebra_alone_decides_what_has_no_dataset(judged):
    by_algebra = judged["decided_by"].values == "algebra"
    without = [
        claim
        for claim in claims.CLAIMS
        if not claim.datasets or claim.datasets == claims.CONTACT_OF_FIG11
    ]
    # One is computed without a dataset, and one is not testable.
    others = {"static table", "other problems"}
    assert {*judged["claim"].values[by_algebra]} == {claim.name for claim in without} - others


def test_three_statements_cannot_fail(judged):
    certain = judged["claim"].values[judged["own_sense"].values == "cannot fail"]
    assert [*certain] == ["no assumptions", "bounces off later", "six unknowns"]


def test_thresholds_are_compared_from_the_printed_ratio_on(judged):
    """At ϖ = 6, which is no point of the grid, Eq. 33 has a closed form."""
    zeta = independent.restitution_to_damping(0.65)
    exact = 1 - np.sqrt(1 + (4 * zeta**2 - 2) / 36 + 1 / 36**2)
    difference = judged["found"].sel(claim="different below 6 only")
    assert float(difference) == pytest.approx(exact, rel=1e-5)


def test_restored_formulas_cover_the_equations_and_name_members():
    numbers = []
    for equations, _, members in claims.FORMULAS:
        # "Eqs. 1, 3 and 4" and "Eqs. 18-20"
        text = equations.partition(" ")[2].replace(" and ", ", ")
        for part in text.split(", "):
            first, _, last = part.partition("-")
            numbers += range(int(first), int(last or first) + 1)
        for member in members.split(", "):
            module, _, path = member.partition(".")
            assert attrgetter(path)(importlib.import_module(f"bouncing_ball.{module}")) is not None
    assert sorted(numbers) == list(range(1, 39))


def test_the_page_and_the_csv_have_every_claim(judged):
    page = judgements.claims_markdown(judged, claims.INTRODUCTION, "Table 1")
    rows = list(csv.reader(io.StringIO(texts.comma_separated(judgements.all_claims(judged)))))
    assert len(rows) == 1 + judged.sizes["claim"]
    assert {len(row) for row in rows} == {len(rows[0])}
    lines = [line for line in page.splitlines() if line.startswith("|")]
    for name, item in zip(judged["claim"].values, judged["item"].values, strict=True):
        elsewhere = item == "Table 1" or item == name
        assert any(line.startswith(f"| {name} |") for line in lines) == (not elsewhere)
    for group, columns in judgements.SECTIONS.items():
        header, *body = judgements.chosen(columns, judgements.claims_of(judged, group))
        assert len(body) == int((judged["group"] == group).sum())
        assert header == [*columns]
    # A cell must not end a cell.
    assert not any("|" in cell for row in rows for cell in row)

"""The article, its supplement and the list of figures, written from the reference's datasets."""

import re
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from bouncing_ball import article, claims, spring_damper, tables
from bouncing_ball.datasets import printed_table
from bouncing_ball.verdicts import LIMIT

ROOT = Path(__file__).resolve().parents[1]
TEXTS = ("paper", "supplement", "figures")
FAMILY_PARAMETERS = {
    "table1": {"n": [0], "frequency_ratio": [1]},
    "fig03": {"n": [1, 2]},
    "fig05": {"case": [1], "frequency_ratio": slice(0, 100)},
    "fig06": {"case": [1]},
    "fig08": {"frequency_ratio": [1]},
    "fig10": {"case": [2]},
    "lowest_doubling": {"n": [1]},
    "thresholds": {"tolerance": [0]},
}
"""What is left of datasets that are computed for fewer cases than the paper's."""


@pytest.fixture(scope="module")
def data() -> dict[str, xr.Dataset]:
    """All datasets of the reference by name."""
    return {path.stem: xr.load_dataset(path) for path in (ROOT / "figures").glob("*.nc")}


def decimals(text: str) -> set[str]:
    """The numbers with a decimal point in a text, without headings and references."""
    body = re.sub(r"^#.*$", "", text.partition("## References")[0], flags=re.MULTILINE)
    return set(re.findall(r"(?<![\w.])\d+\.\d+(?![\w.])", body))


def changed(dataset: xr.Dataset, seed: int) -> xr.Dataset:
    """A dataset whose computed numbers are all different, each by a factor of its own."""
    random = np.random.default_rng(seed)
    numbers = {
        name: variable * random.uniform(1.5, 2.5, variable.shape)
        for name, variable in dataset.data_vars.items()
        # Printed numbers are not computed, and places along a branch must remain in their order.
        if variable.dtype.kind == "f" and "printed" not in name and name != "special_arclength"
    }
    given = {name: 2 * value for name, value in dataset.attrs.items() if isinstance(value, float)}
    return dataset.assign(numbers).assign_attrs(given)


def known(data: dict[str, xr.Dataset]) -> set[str]:
    """The numbers with a decimal point that no computation gives."""
    printed = printed_table(ROOT / "config" / "table1_printed.csv")
    numbers = set(printed.values.flat) | set(data["claims"].printed_text.values)
    readings = data["table1_readings"]
    for name in ("printed_stable_width", "printed_stable_width_rounding"):
        numbers |= {article.fixed(value, 4) for value in readings[name].values.flat}
    rows = printed.astype(float).sortby("frequency_ratio", ascending=False)
    moves = abs(rows / rows[0] - 1).max(["n", "bound"])
    numbers |= {article.percent(move, 1).removesuffix(" %") for move in moves.values}
    parameters = "".join(each.attrs["parameters"] for each in data.values())
    numbers |= set(re.findall(r"\d+\.\d+", parameters))
    # Formulas of parameters: tolerances in per cent, an impact at rest, a doubling by Eq. 8.
    return numbers | {"0.5", "0.2", "0.1", "0.0022", "0.0227", "3.1"}


@pytest.fixture(scope="module")
def three_others(data):
    """The datasets with all numbers changed, three times."""
    printed = printed_table(ROOT / "config" / "table1_printed.csv")
    found = []
    for first in (0, 100, 200):
        others = {key: changed(each, first + seed) for seed, (key, each) in enumerate(data.items())}
        # Conditions in words have the numbers with which they were judged.
        others["claims"] = claims.judge(others, printed).assign_attrs(data["claims"].attrs)
        found.append(others)
    return found


@pytest.mark.parametrize("name", TEXTS)
def test_every_computed_number_follows_a_dataset(name, data, three_others):
    remaining = decimals(article.filled_in(name, data)) - known(data)
    assert len(remaining) > 10
    # A number may be there again by chance, but not three times.
    for others in three_others:
        remaining &= decimals(article.filled_in(name, others))
    assert remaining == set()


def test_counts_follow_a_dataset(data):
    """They are integers, which the test before does not change."""
    table = data["table1_readings"]
    more = data | {"table1_readings": table.assign(unreachable=table.unreachable + 20)}
    assert "and 23 of the printed saddle-nodes" in article.filled_in("paper", more)
    more = data | {"table1_readings": table.assign(reproduced=table.reproduced + 50)}
    assert "none of them reproduces more than 53 of these" in article.filled_in("paper", more)


def template(name: str) -> str:
    """A template without formulas, code, links and references, and numbers that may be typed."""
    text = (ROOT / "workflow" / "templates" / f"{name}.md.j2").read_text("utf-8")
    text = text.partition("## References")[0]
    allowed = [
        r"(?s:\{%.*?%\})",
        r"(?s:\{\{.*?\}\})",
        r"(?s:\$\$.*?\$\$)",
        r"\$[^$\n]*\$",
        r"`[^`\n]*`",
        r"\]\([^)\n]*\)",
        r"<[^>\n]*>",
        r"\[\d+(?:, \d+)*\]",
        r"^#.*$",
        r"\b(?:Eq\.|Fig\.|Figure|Table|Section) S?\d+(?:\.\d)?",
        r"\b(?:Eqs\.|Figs\.) \d+(?:(?:, | and |–)\d+)*",
        r"\bR1\b",
        r"\b1-T\b",
        r"\b1/ϖ",
    ]
    for pattern in allowed:
        text = re.sub(pattern, "", text, flags=re.MULTILINE)
    return text


@pytest.mark.parametrize("name", TEXTS)
def test_templates_have_no_typed_numbers(name):
    lines = [line for line in template(name).splitlines() if re.search(r"\d", line)]
    assert lines == []


@pytest.mark.parametrize("name", TEXTS)
def test_expressions_of_templates_have_no_typed_numbers(name):
    text = (ROOT / "workflow" / "templates" / f"{name}.md.j2").read_text("utf-8")
    expressions = re.findall(r"\{\{(.*?)\}\}|\{%(.*?)%\}", text, flags=re.DOTALL)
    bare = [re.sub(r'"[^"]*"', "", each) for pair in expressions for each in pair]
    # Digits of names, places in lists and numbers of decimals are no results.
    rest = re.sub(r"\(\d\)|\[[-:\d\]\[]+\]", "", "\n".join(bare))
    assert set(re.findall(r"(?<![\w.])\d[\d.]*", rest)) <= {"0", "1", "2"}


@pytest.mark.parametrize("name", TEXTS)
def test_texts_are_written_for_other_parameters(name, data):
    others = data | {key: data[key].isel(chosen) for key, chosen in FAMILY_PARAMETERS.items()}
    for key in FAMILY_PARAMETERS:
        others[key] = others[key].assign_attrs(
            parameters=data[key]
            .attrs["parameters"]
            .replace('"restitution": 0.', '"restitution": 0.0')
        )
    printed = printed_table(ROOT / "config" / "table1_printed.csv")
    others["claims"] = claims.judge(others, printed).assign_attrs(data["claims"].attrs)
    text = article.filled_in(name, others)
    assert "nan" not in text.lower().split()
    if name == "paper":
        assert "other parameters than the paper's" in text


@pytest.mark.parametrize("name", TEXTS)
def test_texts_of_the_paper_have_no_gaps(name, data):
    text = article.filled_in(name, data)
    assert "{{" not in text and "{%" not in text
    assert not re.search(r"(= |to |by )–|not asked|not computed", text)


@pytest.mark.parametrize("name", TEXTS)
def test_verdicts_are_those_of_the_claims(name, data):
    unjudged = data["claims"].copy()
    unjudged["verdict"] = unjudged.verdict.astype(object).where(False, "open")
    text = article.filled_in(name, data | {"claims": unjudged})
    assert not re.search(r"is (reproduced|contradicted|undecidable)\b", text)
    if name == "figures":
        rows = [line for line in text.splitlines() if line.endswith("* |")]
        assert {row.split("|")[-2].strip() for row in rows if "18 numbers" not in row} == {"*open*"}


def test_missing_numbers_are_dashes(data):
    unknown = data["fig14"].assign(error_threshold=np.nan)
    assert "agree to 1 % is reproduced (–, printed 82)" in article.filled_in(
        "paper", data | {"fig14": unknown}
    )


# Statements in words, which have no number in their template


def test_what_the_article_says_of_a_frequency_ratio_of_one_hundred(data):
    errors = claims.stiff_errors(**{name: data[name] for name in article.STIFF_CURVES})
    beyond = errors > LIMIT
    r = np.concatenate([data[name].restitution.values for name in article.STIFF_CURVES])
    least = r == r.min()
    assert not beyond.sel(measure="max_height").any()
    for measure in ("bounce_velocity", "apparent_restitution"):
        assert np.array_equal(beyond.sel(measure=measure), least)
    assert beyond.sel(measure="phase").sum() > r.size / 2
    assert np.array_equal(errors.argmax("orbit").sel(measure="phase"), np.flatnonzero(least)[0])
    worst = errors.max("orbit")
    velocity, apparent = (
        article.percent(worst.sel(measure=measure), 2)
        for measure in ("bounce_velocity", "apparent_restitution")
    )
    phase = article.percent(worst.sel(measure="phase"), 1)
    text = article.filled_in("paper", data)
    assert f"velocity (off by up to {velocity}) and the apparent restitution coefficient" in text
    assert f"coefficient ({apparent}), both at r = 0.1" in text
    assert f"relative to its own value ({phase})" in text
    assert f"the curve of r = 0.1 only, with {velocity} and {apparent}." in text


def test_what_the_article_says_of_the_branches(data):
    """On the most compliant contact the branch is stable thrice and ends in permanent contact."""
    fig08 = data["fig08"]
    compliant = fig08.sel(frequency_ratio=fig08.frequency_ratio.min())
    ranges = claims.stable_ranges(compliant)
    assert len(ranges) == 3
    first, _, last = ranges
    assert max(first[0], last[0]) < min(first[1], last[1])
    threshold = spring_damper.permanent_contact(compliant.frequency_ratio, fig08.damping_ratio)
    assert float(first[0]) == pytest.approx(float(threshold), abs=1e-6)
    computed = data["table1"].computed.sel(frequency_ratio=compliant.frequency_ratio, n=1)
    assert last == pytest.approx(computed.values, rel=1e-9)
    for ratio in fig08.frequency_ratio.values[:-1]:
        branch = fig08.sel(frequency_ratio=ratio)
        assert "permanent contact" not in branch.end_reason.sel(end="unstable side").item()
        assert len(claims.stable_ranges(branch)) == 1


def test_stable_ranges_are_those_of_the_orbits(data):
    for ratio in data["fig08"].frequency_ratio.values:
        branch = data["fig08"].sel(frequency_ratio=ratio)
        ranges = claims.stable_ranges(branch)
        stable = branch.amplitude.values[branch.stable.values]
        assert all(any(low <= each <= high for low, high in ranges) for each in stable)


def test_what_the_article_says_of_table_1(data):
    doublings = data["table1"].computed.sel(bound="period doubling").sortby("frequency_ratio")
    compliant, moderate, stiff = doublings.values
    assert (moderate < stiff).all() and (compliant > stiff).all()
    nodes = data["table1"].computed.sel(bound="saddle-node").sortby("frequency_ratio")
    assert (np.diff(nodes.values, axis=0) > 0).all()
    numbers = tables.claims_of(data["claims"], "printed number")
    ends = [claim for claim in numbers if claim["item"] == "Table 1"]
    missed = {end["claim"]: end for end in ends if end["verdict"] == "not to the digit"}
    assert len(missed) == 14
    by_formula = {name for name in missed if name.startswith("Table 1: 10000")}
    assert by_formula == {f"Table 1: 10000, {n}, period doubling" for n in (1, 2, 3)}
    # The template takes them for the ends that have a remark.
    assert by_formula == {name for name, end in missed.items() if end["remark"]}


def test_all_orbits_drawn_are_admissible(data):
    assert all(each.admissible.all() for each in data.values() if "admissible" in each)


def test_what_the_article_says_of_figures_6_10_and_16(data):
    fig06, fig10, fig16 = (data[name] for name in ("fig06", "fig10", "fig16"))
    dips = (fig06.restitution - fig06.apparent_restitution.min("frequency_ratio")).values
    assert dips[0] > 0.005 and dips[-1] < 1e-6
    compliant = fig06.apparent_restitution.isel(frequency_ratio=0)
    assert [article.fixed(value, 2) for value in compliant] == ["0.81"] * 3
    departure = 1 - fig10.bounce_velocity / fig10.restitution_bounce_velocity
    assert (departure > 0).all()
    ratio = fig10.frequency_ratio.values
    law = (departure * ratio).sel(frequency_ratio=ratio[ratio > 50]).values
    assert np.ptp(law) < 0.02 * law.mean()
    larger = spring_damper.permanent_contact_ratios(0.99, float(fig16.damping_ratio))[1]
    assert larger == pytest.approx(float(fig16.error_threshold), rel=1e-9)


# Numbers as text


def test_numbers_are_rounded_correctly():
    values = np.random.default_rng(5).uniform(-2, 2, 200)
    for value in values:
        off = Decimal(article.fixed(value, 3).replace("−", "-")) - Decimal(value)
        assert abs(off) <= Decimal("0.0005")
        bound = Decimal(article.at_most(abs(value), 2).removesuffix(" %")) - 100 * Decimal(
            abs(value)
        )
        assert 0 <= bound < Decimal("0.01")


def test_only_powers_of_ten_are_written_as_such():
    numbers = [article.short(value) for value in (1e4, 2e4, 1e3, 0.25, -0.5, 0.0)]
    assert numbers == ["10⁴", "20000", "1000", "0.25", "−0.5", "0"]


def test_ends_of_table_1_that_are_not_judged_are_not_counted(data):
    judged = data["claims"]
    open_ends = judged.claim.str.startswith("Table 1: 2,")
    others = judged.assign(verdict=judged.verdict.astype(object).where(~open_ends, "not asked"))
    text = article.filled_in("paper", data | {"claims": others})
    assert "Of the 12 ends of stability ranges in Table 1" in text


def test_bounds_that_are_decimal_numbers_stay():
    assert article.at_most(0.01, 2) == "1.00 %"
    assert article.percent(0.01) == "1 %"
    assert article.percent(0.355, 0) == "36 %"


def test_missing_labels_give_a_dash():
    values = xr.DataArray([1.0, 2.0], {"n": [1, 2]}, ("n",))
    assert article.fixed(article.at(values, n=2), 1) == "2.0"
    assert article.fixed(article.at(values, n=3), 1) == "–"

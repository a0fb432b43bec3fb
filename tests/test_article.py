"""The article, its supplement and the list of figures, written from the reference's datasets."""

import re
from decimal import Decimal
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from jinja2 import TemplateSyntaxError
from tests import independent
from tests.reference import reference, with_more, with_parameters, without_gaps

from bouncing_ball import restitution, spring_damper
from bouncing_ball.errors import errors_of_orbits, orbits_along
from bouncing_ball.orbits import Family
from carbonelli2011 import article, claims, measures, paper
from carbonelli2011.paper import LIMIT, STIFF
from paper_replication import judgements, origins, templates, texts
from paper_replication.datasets import parameters
from paper_replication.verdicts import VERDICTS

ROOT = Path(__file__).resolve().parents[1]
TEXTS = ("paper", "supplement")
TEMPLATES = sorted(article.TEMPLATES.glob("*.j2")) + sorted(ROOT.glob("src/paper_rep*/*.html.j2"))


@pytest.fixture(scope="module")
def data() -> dict[str, xr.Dataset]:
    """All datasets of the reference by name, with the curves and rows of the paper."""
    return paper.of_paper(reference())


@cache
def text_of_reference(name: str) -> str:
    """A text as the reference has it."""
    return text_of(name, reference())


def text_of(name: str, data: dict[str, xr.Dataset]) -> str:
    """The article or its supplement."""
    return origins.bare(article.text(name, data))


def decimals(text: str) -> set[str]:
    """The numbers with a decimal point in a text, without those of sections and references."""
    body = re.sub(r"^#.*$|Section \S+", "", text.partition("## References")[0], flags=re.MULTILINE)
    return set(re.findall(r"(?<![\w.])\d+\.\d+(?![\w.])", body))


def changed(dataset: xr.Dataset, seed: int) -> xr.Dataset:
    """A dataset whose numbers are all different, each by a factor of its own."""
    random = np.random.default_rng(seed)
    numbers = {
        name: variable * random.uniform(3, 6, variable.shape)
        for name, variable in dataset.data_vars.items()
        # Places along a branch must remain in their order.
        if variable.dtype.kind == "f" and name != "special_arclength"
    }
    given = {name: 2 * value for name, value in dataset.attrs.items() if isinstance(value, float)}
    return dataset.assign(numbers).assign_attrs(given)


@cache
def texts_of_other_numbers(seed: int) -> dict[str, str]:
    """Both texts, from datasets and formulas that give other numbers."""
    data = reference()
    others = {key: changed(dataset, seed + k) for k, (key, dataset) in enumerate(data.items())}
    # Conditions as text have the numbers with which they were judged. What these numbers cannot
    # decide would make it the article of another run.
    judged = claims.judge(others).assign_attrs(data["claims"].attrs)
    others["claims"] = judged.assign(verdict=data["claims"].verdict)
    with pytest.MonkeyPatch.context() as patch:
        for module, name in (
            (measures, "error_of_eq_8"),
            (measures, "restitution_at_rest"),
            (restitution, "period_doubling_height"),
        ):
            formula = getattr(module, name)
            patch.setattr(module, name, lambda *given, formula=formula: 0.7 * formula(*given))
        return {name: text_of(name, others) for name in TEXTS}


def test_a_sentence_that_needs_what_the_results_lack_names_its_line(data):
    """Here no other contact gives the printed 82, which the article lists."""
    hypotheses = data["hypotheses"].copy(deep=True)
    hypotheses.agrees[:] = False
    with pytest.raises(ValueError, match="not enough values") as stopped:
        text_of("paper", data | {"hypotheses": hypotheses})
    (note,) = stopped.value.__notes__
    number = int(re.fullmatch(r"paper\.md\.j2, line (\d+)", note).group(1))
    lines = (article.TEMPLATES / "paper.md.j2").read_text("utf-8").splitlines()
    assert "{{ others_with_82 | listed }}" in lines[number - 1]


@pytest.mark.parametrize("name", TEXTS)
def test_every_computed_number_follows_a_dataset_or_a_formula(name, data):
    """Only parameters and what the paper prints stay as they are. No number is typed in Python."""
    stays = set(data["claims"].printed_text.values)
    parameters = "".join(dataset.attrs["parameters"] for dataset in data.values())
    stays |= set(re.findall(r"\d+\.\d+", parameters))
    remaining = decimals(text_of_reference(name)) - stays
    # A number may be there again by chance, but not three times.
    for seed in (0, 100, 200):
        other = texts_of_other_numbers(seed)[name]
        assert other.partition("\n")[0] == text_of_reference(name).partition("\n")[0]
        remaining &= decimals(other)
    assert remaining == set()


@pytest.mark.parametrize("name", ["paper", "supplement"])
def test_numbers_follow_no_dataset_that_their_expressions_do_not_name(name, data):
    def gave(datasets: dict[str, xr.Dataset]) -> dict[int, list[str]]:
        return origins.printed(article.text(name, datasets))

    origin = article.origins_of(name, data)
    before = gave(data)
    names = sorted(data)
    half = len(names) // 2
    moved = []
    # Two at a time: those that one expression names are seldom half of the list apart.
    for place in range(half):
        pair = names[place::half]
        after = gave(data | {key: changed(data[key], 0) for key in pair})
        moved += [(pair, n) for n in before if n in after and before[n] != after[n]]
    assert len(moved) > 10
    assert [(pair, n) for pair, n in moved if not {*pair} & {*origin[n].datasets}] == []


SPELLED = {
    "{{ fig14.n }}": {"fig14"},
    "{{ fig14.n|abs }}": {"fig14"},
    "{{ 'fig14 }}' ~ fig15.n }}": {"fig15"},
    '{{ "\\"" ~ fig14.n ~ "\\"" }}': {"fig14"},
    "{{ given.fig14.n }}": {"fig14"},
    "{{ given['fig14'].n }}": {"fig14", "fig15"},
    "{{ 1 | abs(fig14=2) ~ other.fig14 }}": set(),
    "{# {{ fig14.n }} #}{% raw %}{{fig14}}{% endraw %}{{ fig15.n }}": {"fig15"},
    "{% set x = fig14.n -%}\n{% if fig15 %}{{ x }}{% endif %}": {"fig14"},
    "{% for x, y in fig14.n if y %}{{ x }}{% endfor %}": {"fig14"},
    "{% for fig14 in [1] %}{% endfor %}{{ fig14.n }}": {"fig14"},
    "{% macro f(fig15) -%}{% endmacro %}{{ fig15.n }}": {"fig15"},
}


@pytest.mark.parametrize("source", SPELLED)
def test_the_last_number_has_its_origin(source):
    last = origins.origins(source, ["fig14", "fig15"])[-1]
    assert {*last.datasets} == SPELLED[source]


def test_a_macro_prints_what_its_body_and_its_arguments_name():
    source = "{% macro f(y) -%}{{ y }}{{ fig14.n }}{%- endmacro %}{{ f(fig15.n) }}"
    expressions = origins.origins(source, ["fig14", "fig15"])
    assert [{*expression.datasets} for expression in expressions] == [
        set(),
        {"fig14"},
        {"fig14", "fig15"},
    ]


@pytest.mark.parametrize(
    "statement",
    [
        "{{x}}",
        "{{- x }}",
        "{{ x -}}",
        "{{ x\n}}",
        "{%- set a = x %}",
        "{% set a=x %}",
        "{% set a, b = x %}",
        "{% set a.b = x %}",
        "{% set a %}{{ x }}{% endset %}",
        "{% with a = x %}{% endwith %}",
        "{% for (a, b) in x %}{% endfor %}",
        "{% macro f(a=x) %}{% endmacro %}",
        "{% call f() %}{% endcall %}",
        '{% include "a.j2" %}',
        '{% from "a.j2" import x %}',
        # A name that has another meaning in between.
        "{% if a %}{% set a = x %}{% endif %}{% set a = 1 %}",
        "{% for a in x %}{% set a = 1 %}{% endfor %}",
        "{% macro f() %}{{ a }}{% endmacro %}{% set a = x %}",
        "{% macro f() %}{% endmacro %}{% macro f() %}{% endmacro %}",
    ],
)
def test_a_statement_that_would_lose_a_source_is_refused(statement):
    """The marks of any paper are refused, with the line and the statement."""
    marking = templates.environment(Path(), marked=True)
    with pytest.raises(TemplateSyntaxError, match=r"write|another name") as error:
        marking.from_string("{% set y = x %}\n" + statement)
    assert error.value.lineno > 1
    spelling = str(error.value).partition(": ")[0]
    assert spelling.startswith("{") and spelling in statement


def test_counts_follow_a_dataset(data):
    """They are integers, which the test before does not change."""
    counts = {"below_orbits": 7001, "compliant_reproduced": 7002}
    others = {name: data["hypotheses"][name] * 0 + count for name, count in counts.items()}
    others = data | {"hypotheses": data["hypotheses"].assign(others)}
    text = origins.bare(article.text("paper", others))
    assert [str(count) in text for count in counts.values()] == [True, True]


@pytest.mark.parametrize("place", [0, 1, -1])
def test_a_further_curve_or_row_changes_no_sentence(data, place):
    more = {
        name: with_more(dataset, paper.PARAMETERS.get(name, {}), place)
        for name, dataset in data.items()
    }
    for name in TEXTS:
        assert text_of(name, more) == text_of_reference(name)


def template(path: Path) -> str:
    """A template without formulas, code, links and references, and numbers that may be typed."""
    text = path.read_text("utf-8")
    text = text.partition("## References")[0]
    allowed = [
        r"(?s:<(style|pre)>.*?</\1>)",
        r"\bDETC2011-47870 \(2011\)",
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


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: path.name)
def test_templates_have_no_typed_numbers(path):
    """A result that would stay as it is when its dataset changes is caught."""
    lines = [line for line in template(path).splitlines() if re.search(r"\d", line)]
    assert lines == []


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: path.name)
def test_expressions_of_templates_have_no_typed_numbers(path):
    """A typed result that would pass for a computed one is caught."""
    text = path.read_text("utf-8")
    expressions = re.findall(r"\{\{(.*?)\}\}|\{%(.*?)%\}", text, flags=re.DOTALL)
    bare = [re.sub(r'"[^"]*"', "", expression) for pair in expressions for expression in pair]
    # Digits of names, places in lists and numbers of decimals are no results.
    rest = re.sub(r"\(\d(?:, )?\)|\[[-:\d\]\[]+\]", "", "\n".join(bare))
    assert set(re.findall(r"(?<![\w.])\d[\d.]*", rest)) <= {"0", "1", "2"}


def test_the_article_of_a_run_with_other_parameters_names_them(data):
    others = {
        "fig14": with_parameters(data["fig14"], n=2),
        "fig11": with_parameters(data["fig11"], restitution=0.7),
        "table1": with_parameters(data["table1"], frequency_ratio=[1e4, 50.0]),
    }
    for name in ("paper", "supplement"):
        text = origins.bare(article.text(name, data | others))
        assert re.findall("^- [a-z].*", text, re.MULTILINE) == [
            "- fig11: restitution is 0.7 instead of 0.65",
            "- fig14: n is 2 instead of 1",
            "- table1: frequency_ratio lacks 10.0, 2.0",
        ]
        assert len(text.splitlines()) < 30
    forced = {name: with_parameters(data[name], release="force") for name in ("fig05", "fig06")}
    line = "- fig05, fig06: release is force instead of displacement\n"
    assert line in article.text("paper", data | forced)


def test_the_article_of_a_run_without_a_number_that_a_claim_needs_says_so(data):
    others = data | {"fig14": data["fig14"].assign(error_threshold=np.nan)}
    others["claims"] = claims.judge(others).assign_attrs(data["claims"].attrs)
    assert "- a number that decides it is missing in fig14\n" in article.text("paper", others)


def test_the_article_does_not_depend_on_the_number_of_points(data):
    axis = parameters(data["fig14"])["frequency_ratio"] | {"samples": 77}
    others = data | {"fig14": with_parameters(data["fig14"], frequency_ratio=axis)}
    assert origins.bare(article.text("paper", others)) == text_of_reference("paper")


@pytest.mark.parametrize("name", TEXTS)
def test_texts_of_the_paper_have_no_gaps(name, data):
    """A number that a dataset lacks, or a claim that is not judged, is caught."""
    with without_gaps():
        text = text_of(name, data)
    assert "{{" not in text and "{%" not in text
    assert "another run" not in text


@pytest.mark.parametrize("name", TEXTS)
def test_verdicts_are_those_of_the_claims(name, data):
    """A verdict that is typed in a template is caught."""
    unjudged = data["claims"].copy()
    # The article compares ends of Table 1.
    ends = (unjudged.item == "Table 1") & (name == "paper")
    unjudged["verdict"] = unjudged.verdict.astype(object).where(ends, "open")
    text = text_of(name, data | {"claims": unjudged})
    assert not re.search(rf"is ({'|'.join(VERDICTS)})\b", text)


# Bounds


def stiff_errors(data: dict[str, xr.Dataset]) -> dict[str, float]:
    """The largest errors at ϖ >= 100 on Figs. 5, 6 and 10, in per cent, from the formulas."""
    largest = []
    for name, n in zip(article.STIFF_CURVES, (1, 1, 2), strict=True):
        curve = data[name].sel(frequency_ratio=slice(99.9, None))
        x = n * np.pi * (1 - curve.restitution) / (1 + curve.restitution)
        impact_height = np.sqrt(curve.amplitude**2 - x**2)
        errors = {
            "height": curve.max_height / (impact_height + (n * np.pi) ** 2 / 2) - 1,
            "velocity": curve.bounce_velocity / (n * np.pi) - 1,
            "restitution": curve.apparent_restitution / curve.restitution - 1,
            "phase": (curve.phase - np.arctan2(impact_height, x)) / (2 * np.pi),
        }
        largest.append({key: 100 * float(abs(error).max()) for key, error in errors.items()})
    return {key: max(figure[key] for figure in largest) for key in largest[0]}


def bounded(data: dict[str, xr.Dataset]) -> dict[str, float]:
    """What the bounds of the texts are about, in their units; shares are in per cent."""
    contacts = [data[name].contact_duration for name in ("fig08", "fig09")]
    exact, holmes = data["table1"].restitution_range.sel(bound="period doubling").values
    numbers = data["claims"].where(data["claims"].item == "Table 1", drop=True)
    velocity = data["fig10"].bounce_velocity / (2 * np.pi)
    # The dataset may have rows that the paper does not print.
    table = data["table1"].sel(frequency_ratio=[1e4, 10.0, 2.0])
    rows = table.printed
    computed = table.computed
    thresholds = data["thresholds"].error_threshold
    quantities = {
        "longest contact": max(durations.sel(frequency_ratio=1e4).max() for durations in contacts),
        "shortest contact": min(durations.sel(frequency_ratio=2.0).min() for durations in contacts),
        "spread": 100 * (velocity.max("case") - velocity.min("case")).max(),
        # By the closed form, in test_claims.
        "meeting": 1.27610886,
        "units": abs(numbers.deviation_units).max(),
        "share": 100 * abs(numbers.deviation).max(),
        "above Eq. 8": 100 * (exact / holmes - 1).max(),
        "compliant units": 1000 * abs(computed - rows)[1:].max(),
        "hits": data["hypotheses"].compliant_reproduced.max(),
        "least damping": data["hypotheses"].damping_of_82[0],
        "most damping": data["hypotheses"].damping_of_82[1],
        "apparent": max(
            abs(data[name].apparent_restitution - data[name].restitution)
            .sel(frequency_ratio=slice(99.9, None))
            .max()
            for name in ("fig05", "fig06")
        ),
        "saddle-node": thresholds.sel({"quantity": "saddle_node", "tolerance": 0.01}),
        "largest n": data["validity_map"].n.max(),
        "needed": data["validity_map"].enough_from.sel(quantity="summit").max(),
        "doubled": 100 * data["validity_map"].doubled_share[0].max(),
        "moves at 10": 100 * abs(rows[1] / rows[0] - 1).max(),
        "moves at 2": 100 * abs(rows[2] / rows[0] - 1).max(),
        "lowest flight": min(
            (data[name].max_height.isel(frequency_ratio=-1) / data[name].amplitude).min()
            for name in article.STIFF_CURVES
        ),
    }
    return {key: float(value) for key, value in quantities.items()} | stiff_errors(data)


PRINTED = {
    "paper": [
        "longest contact",
        "shortest contact",
        "spread",
        "meeting",
        "units",
        "share",
        "lowest flight",
        "above Eq. 8",
        "compliant units",
        "height",
        "phase",
        "apparent",
        "saddle-node",
        "needed",
        "doubled",
    ],
    "supplement": ["moves at 10", "moves at 2", "least damping", "most damping"],
}
"""What the texts print of `bounded`."""

NUMBER = r"(\d+(?:\.\d+)?)"
BOUND = (
    r"(?:[Aa]t (?:most|least)|up to|within|(?:more|less) than"
    r"|(?:long|great|larg|high|short|small|low)er than)"
    rf" (?:[Λϖr] = )?{NUMBER}(?!ζ)|from ϖ = {NUMBER} on|{NUMBER}(?: %)? (?:at most|or more)"
)
"""A bound, which rounding to the nearest could make false."""


@pytest.mark.parametrize("name", PRINTED)
def test_largest_and_smallest_numbers_are_those_of_their_own_formulas(name, data):
    """No computed number is printed as a bound, and each number is rounded correctly."""
    text = text_of(name, data).partition("## References")[0]
    # Counts, the tolerance of 1 % and the frequency ratio of the advice are exact.
    true = bounded(data)
    exact = {"1", f"{STIFF:g}", f"{true['hits']:g}", f"{true['largest n']:g}"}
    numbers = {"".join(groups) for groups in re.findall(BOUND, text)}
    assert numbers - exact == set()
    numbers = re.findall(r"\d+(?:\.\d+)?", text)
    for what in PRINTED[name]:
        units = [10.0 ** -len(number.partition(".")[2]) for number in numbers]
        off = [abs(float(number) - true[what]) for number in numbers]
        # A half, up to rounding errors of the datasets.
        assert any(
            distance <= 0.500001 * unit for distance, unit in zip(off, units, strict=True)
        ), what
    limits = re.findall(r"n = (\d) up to r ≈ (\d+\.\d+)", text)
    assert bool(limits) == (name == "paper")
    for n, number in limits:
        fails = data["validity_map"].failing_up_to.sel(n=int(n)).values
        assert np.nanmin(abs(fails - float(number))) <= 0.005


# Statements in words, which have no number in their template


def test_what_the_article_says_of_a_frequency_ratio_of_one_hundred(data):
    errors = measures.stiff_errors(*(data[name] for name in article.STIFF_CURVES))
    curves = {
        (n, float(r), float(amplitude))
        for name, n in zip(article.STIFF_CURVES, (1, 1, 2), strict=True)
        for r, amplitude in zip(data[name].restitution, data[name].amplitude, strict=True)
    }
    assert errors.sizes["orbit"] == len(curves) == 9
    beyond = errors > LIMIT
    least = np.array(["r = 0.1," in orbit for orbit in errors.orbit.values])
    assert least.sum() == 1
    assert not beyond.sel(measure=["max_height", "phase"]).any()
    for measure in ("bounce_velocity", "apparent_restitution"):
        assert np.array_equal(beyond.sel(measure=measure), least)


def test_what_the_article_says_of_the_hypotheses(data):
    """Those that give 82 and 0.81 differ in the stability alone, and none explains Table 1."""
    hypotheses = data["hypotheses"]
    both = hypotheses.deviation_units.sel(number=["height threshold", "compliant end of 1.2"])
    given = hypotheses.hypothesis[(abs(both) <= 0.5).all("number")].values.tolist()
    assert "equations as they stand" in given
    numbers = hypotheses.found[:, hypotheses.row.isnull().values]
    own = numbers.sel(hypothesis="equations as they stand")
    assert all((numbers.sel(hypothesis=name) == own).all() for name in given)
    assert article.others_with_82(hypotheses) == ["force release, equal r"]
    assert hypotheses.compliant_reproduced.max() < 12 / 2


def test_what_the_article_says_of_the_map(data):
    validity_map = data["validity_map"]
    assert validity_map.not_reached.sum() == 0
    # The orbits that are stable in both models, and the limits at their saddle-nodes.
    fails = (validity_map.stiff_error > LIMIT) & (validity_map.stable | (validity_map.place == 0))
    # Beside the saddle-node, nowhere for n = 3, and for a whole range.
    for quantity in ("summit", "phase_in_periods"):
        one = fails.sel(quantity=quantity)
        assert (one.cumprod("place").sum("place") == one.sum("place")).all()
        assert not one.sel(n=3).any() and one.sel(n=2).any()
    velocity = validity_map.stiff_error.sel(quantity="bounce_velocity")
    assert (velocity.max("place") < 1.02 * velocity.min("place")).all()
    assert not fails.sel(quantity="bounce_velocity", n=[2, 3]).any()
    # Next to the upper end for each n; next to the lower one for n = 1, and for n = 2 at one r.
    apparent = fails.sel(quantity="apparent_restitution")
    assert apparent.where(validity_map.place > 0.3, False).any(["restitution", "place"]).all()
    lower = apparent.where(validity_map.place < 0.2, False).any("place").sum("restitution")
    assert lower[0] > 2 and lower[1:].values.tolist() == [1, 0]
    assert not apparent.sel(place=0.2, method="nearest").isel(restitution=slice(3, None)).any()
    # Largest errors are limits: at the saddle-node, of the apparent restitution at the other end.
    at_node = validity_map.stiff_error.isel(place=0).max(["n", "restitution"])
    largest = validity_map.largest_error.max("n")
    assert largest.values[[0, 3]] == pytest.approx(at_node.values[[0, 3]], rel=1e-5)
    # Where the height fails, the ball flies higher on the contact, and on most orbits lower.
    mesh = np.meshgrid(validity_map.n, validity_map.restitution, validity_map.place, indexing="ij")
    n, r, place = (grid.reshape(-1, 1) for grid in mesh)
    low = restitution.saddle_node(n, r)
    amplitude = low + place * (restitution.period_doubling(n, r) - low)
    family = Family(n, spring_damper.Contact.of_restitution(np.array([STIFF]), r))
    orbits = orbits_along(family, amplitude)
    height = errors_of_orbits(family, orbits, r, amplitude)[0].reshape(validity_map.stable.shape)
    assert (height[fails.sel(quantity="summit").values] > LIMIT).all()
    assert (height[validity_map.stable.values] < 0).mean() > 0.5
    # Openings: most orbits are right, and both ends of the range of the contact are lower.
    assert validity_map.failing_mean.sel(quantity="summit").max() < 0.1
    assert (validity_map.below_share > validity_map.doubled_share).all() and (
        validity_map.doubled_share > 0
    ).all()
    needed = validity_map.enough_from.sel(quantity="summit")
    assert needed.argmax(["n", "restitution", "place"]) == {"n": 0, "restitution": 0, "place": 0}


def test_the_orbits_without_damping_are_marginally_stable(data):
    fig05 = data["fig05"]
    curve = fig05.isel(case=int(fig05.restitution.argmax("case")))
    assert curve.restitution == 1
    for ratio, duration in zip(
        curve.frequency_ratio.values, curve.contact_duration.values, strict=True
    ):
        matrix = independent.monodromy(1, ratio, 0.0, "displacement", duration)
        # Complex multipliers of modulus 1.
        assert abs(np.trace(matrix)) < 2
        assert np.linalg.det(matrix) == pytest.approx(1, abs=1e-9)


def test_what_the_article_says_of_the_branches(data):
    """On the most compliant contact the branch is stable thrice and ends in permanent contact."""
    fig08 = data["fig08"]
    compliant = fig08.sel(frequency_ratio=fig08.frequency_ratio.min())
    ranges = measures.stable_ranges(compliant)
    assert len(ranges) == 3
    first, _, last = ranges
    assert max(first[0], last[0]) < min(first[1], last[1])
    threshold = spring_damper.permanent_contact(compliant.frequency_ratio, fig08.damping_ratio)
    assert float(first[0]) == pytest.approx(float(threshold), abs=1e-6)
    computed = data["table1"].computed.sel(frequency_ratio=compliant.frequency_ratio, n=1)
    assert last == pytest.approx(computed.values, rel=1e-9)
    for ratio in fig08.frequency_ratio.values[:-1]:
        branch = fig08.sel(frequency_ratio=ratio)
        assert branch.end_kind.sel(end="unstable side") != "permanent contact"
        assert len(measures.stable_ranges(branch)) == 1


def test_what_the_article_says_of_table_1(data):
    computed = data["table1"].computed
    doublings = computed.sel(bound="period doubling")
    compliant, moderate, stiff = (doublings.sel(frequency_ratio=ratio) for ratio in (2, 10, 1e4))
    assert (moderate < stiff).all() and (compliant > stiff).all()
    nodes = computed.sel(bound="saddle-node").sortby("frequency_ratio")
    assert (nodes.diff("frequency_ratio") > 0).all()
    numbers = judgements.claims_of(data["claims"], "printed number")
    ends = [claim for claim in numbers if claim["item"] == "Table 1"]
    missed = {end["claim"]: end for end in ends if end["verdict"] != "reproduced"}
    assert len(missed) == 14
    assert sum(abs(end["deviation_units"]) <= 1 for end in missed.values()) == 2
    by_formula = {name for name in missed if name.startswith("Table 1: 10000")}
    assert by_formula == {f"Table 1: 10000, {n}, period doubling" for n in (1, 2, 3)}
    # The template takes them for the ends that have a remark.
    assert by_formula == {name for name, end in missed.items() if end["remark"]}


def test_all_orbits_drawn_are_admissible(data):
    drawn = [dataset for name, dataset in data.items() if name.startswith("fig")]
    assert all(dataset.admissible.all() for dataset in drawn if "admissible" in dataset)


def test_what_the_article_says_of_figures_6_10_and_16(data):
    fig06, fig10, fig16 = (data[name] for name in ("fig06", "fig10", "fig16"))
    dips = (fig06.restitution - fig06.apparent_restitution.min("frequency_ratio")).values
    assert dips[0] > claims.line_width(fig06.apparent_restitution) > 100 * abs(dips[-1])
    compliant = fig06.apparent_restitution.isel(frequency_ratio=0)
    assert [texts.fixed(value, 2) for value in compliant] == ["0.81"] * 3
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
        off = Decimal(texts.fixed(value, 3).replace("−", "-")) - Decimal(value)
        assert abs(off) <= Decimal("0.0005")
        exact = 100 * Decimal(value)
        nearest = texts.percent(value, 2).removesuffix(" %").replace("−", "-")
        assert abs(Decimal(nearest) - exact) <= Decimal("0.005")

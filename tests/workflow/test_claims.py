"""The shipped ledger: complete, decided, explained."""

import copy
import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from bouncing_ball.audit.evidence import evidence
from bouncing_ball.claims.assessment import assess
from bouncing_ball.claims.ledger_file import parse_ledger
from bouncing_ball.configuration.stages import STAGES
from bouncing_ball.datasets.netcdf import attribute_name, parameter_attributes, read_dataset

ROOT = Path(__file__).resolve().parents[2]
MAPPING, CONFIG = (
    yaml.safe_load((ROOT / "config" / name).read_text(encoding="utf-8"))
    for name in ("claims.yaml", "config.yaml")
)
LEDGER = parse_ledger(MAPPING)
CLAIMS = {claim.id: claim for claim in LEDGER.claims}


# What each claim rests on.


def test_every_formula_is_claimed_or_explains(pristine):
    rows = read_dataset(pristine.path / "results/figures/formulas.nc").formula.values
    criteria = [c for part in (*LEDGER.claims, *LEDGER.explanations) for c in part.criteria]
    named = {dict(c.measure.at)["formula"] for c in criteria if c.measure.variable == "disagreement"
             and c.measure.dataset == "formulas"}  # fmt: skip
    assert named == set(rows)


def test_every_explanation_is_used():
    used = {claim.explanation for claim in LEDGER.claims} - {""}
    assert used == {explanation.id for explanation in LEDGER.explanations}


@pytest.fixture(scope="module")
def datasets(pristine):
    """All datasets that the evidence may be made of."""
    names = [name for name in LEDGER.datasets if name not in ("evidence", "formulas")]
    folder = pristine.path / "results" / "figures"
    return {name: read_dataset(folder / f"{name}.nc") for name in names}


def moved(dataset):
    """A dataset whose numbers all differ, each by another share, and whose flags are turned."""
    other = dataset.copy(deep=True)
    for name, values in other.data_vars.items():
        if values.dtype.kind == "f":
            share = 1 + 0.1 * np.resize(np.arange(1, 8), values.shape)
            other[name] = values * share
        elif values.dtype.kind == "b":
            other[name] = ~values
    if "tolerance" in other.dims:
        other = other.assign_coords(tolerance=other.tolerance * 1.1)
    return other


def emptied(dataset):
    """A dataset without a number: what is counted is gone, however the numbers move."""
    return dataset.map(lambda x: x * np.nan if x.dtype.kind == "f" else x, keep_attrs=True)


def test_claims_name_all_datasets_behind_their_evidence(datasets):
    settings = CONFIG["studies"]["evidence"]
    before = evidence(datasets, settings)
    with np.errstate(all="ignore"):
        after = [
            (name, evidence(datasets | {name: change(dataset)}, settings))
            for name, dataset in datasets.items()
            for change in (moved, emptied)
        ]
    for part in (*LEDGER.claims, *LEDGER.explanations):
        for measure in (c.measure for c in part.criteria if c.measure.dataset == "evidence"):
            values = before[measure.variable]
            place = tuple(
                values[dim].values.tolist().index(dict(measure.at)[dim])
                if dim in dict(measure.at)
                else slice(None)
                for dim in values.dims
            )
            behind = {
                name
                for name, other in after
                if not np.array_equal(
                    values.values[place], other[measure.variable].values[place], equal_nan=True
                )
            }
            assert behind and behind <= set(part.uses), f"{part.id}: {measure}"


# Parameters that no verdict depends on: how finely a branch is drawn or how far,
# how the continuation steps, and what else a study computes.
HARMLESS = {
    "fig03": {"amplitude_max", "points"},
    "fig08": {"amplitude_max", "points"},
    "fig09": {"amplitude_max", "points"},
    "fig11": {"frequency_ratio.min", "frequency_ratio.max", "frequency_ratio.samples"},
    "fig13": {"frequency_ratio.min", "frequency_ratio.samples"},
    "fig14": {"frequency_ratio.min", "frequency_ratio.samples"},
    "fig15": {"points"},
    "table1": {"amplitude_max"},
    "ext_release": {
        f"thresholds.{key}"
        for key in (
            *("n", "restitution", "amplitude", "tolerance", "quantities"),
            *("frequency_ratio.min", "frequency_ratio.max", "frequency_ratio.samples"),
        )
    },
    "motions": {
        f"ensemble.{key}"
        for key in ("balls", "displacement", "transient", "impacts", "longest_period")
    },
    "formulas": {"samples", "seed", "curve_points"},
    # Other readings may be nearer to the printed table; the explanation asks.
    "forensics": {
        *("printed_damping_ratio", "other_damping_ratios", "stiff_exponents"),
        *("steps", "step_reach", "last_digit"),
    },
}


def test_every_parameter_is_the_papers_or_harmless():
    sections = {
        name: parameters
        for section in ("figures", "tables", "extensions", "studies")
        for name, parameters in CONFIG[section].items()
    }
    for name in LEDGER.datasets:
        if name == "witness":  # holds for all orbits, whatever they are
            continue
        asked = {
            key
            for place, group in MAPPING["parameters"].items()
            if place.partition(".")[0] == name
            for key in group
        }
        given = set(parameter_attributes(sections[name]))
        named = {attribute_name(key) for key in asked | HARMLESS.get(name, set())}
        assert given == named, name
        assert not asked & HARMLESS.get(name, set()), name


# The verdicts of the shipped configuration.


@pytest.fixture(scope="module")
def verdicts(pristine):
    return read_dataset(pristine.path / "results/figures/claims.nc")


def test_nothing_that_differs_is_without_explanation(verdicts):
    assert verdicts.claim.values.tolist() == list(CLAIMS)
    open_ones = verdicts.claim.values[~verdicts.explained.values.astype(bool)].tolist()
    assert open_ones == []
    assert verdicts.explanation_holds.values.astype(bool).all()
    # With the paper's own parameters all claims are asked.
    assert "not asked" not in verdicts.verdict.values


def test_the_tally_counts_the_verdicts(pristine, verdicts):
    line = (pristine.path / "results" / "tally.txt").read_text(encoding="utf-8")
    figures = len(list((pristine.path / "results" / "figures").glob("fig??.png")))
    start, *groups = line.rstrip("\n").split("; ")
    alone = [claim for claim in CLAIMS.values() if not claim.restates]
    assert start == f"{figures} figures, Table 1, {len(alone)} claims"
    counted = 0
    for text in groups:
        name, _, counts = text.partition(": ")
        size, _, group = name.partition(" ")
        own = verdicts.verdict.values[verdicts.group.values == group.removesuffix("s")]
        assert own.size == int(size)
        for count in counts.split(", "):
            number, _, verdict = count.partition(" ")
            assert (own == verdict).sum() == int(number) > 0
            counted += int(number)
    assert counted == len(CLAIMS)


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        ("height threshold", "reproduced"),
        ("permanent contact threshold", "contradicted"),
        ("soft end of 1.2", "reproduced"),
        ("damping of 0.85", "reproduced"),
        ("damping of 0.65, four digits", "reproduced"),
        ("departure from nπ", "undecidable"),
        ("period doubling", "contradicted"),
        ("period doubling rises", "contradicted"),
        ("saddle-node falls", "reproduced"),
        ("Table 1: 10000, 1, saddle-node", "reproduced"),
        ("Table 1: 10000, 1, period doubling", "contradicted"),
        ("Table 1: 10, 3, saddle-node", "close"),
        ("frequency ratio", "undecidable"),
        ("contact equation", "reproduced"),
        ("moving table", "reproduced"),
        ("safe above 100", "undecidable"),
        ("static table", "undecidable"),
        ("closer with stiffness", "undecidable"),
        ("dip at 1.2", "contradicted"),
        ("no analytical solution", "undecidable"),
        ("needs continuation", "contradicted"),
        ("no assumptions", "contradicted"),
        ("representative", "reproduced"),
        ("equations cited", "contradicted"),
        ("figures of existence domains", "contradicted"),
        ("amplitude of Fig. 15", "contradicted"),
        ("restitution law", "reproduced"),
        ("velocity before impact", "reproduced"),
        ("orbit equations", "reproduced"),
    ],
)
def test_verdicts(verdicts, claim, verdict):
    assert verdicts.verdict.sel(claim=claim).item() == verdict


def test_the_tables_show_every_claim_and_formula(pristine, verdicts):
    folder = pristine.path / "results" / "figures"
    lines = (folder / "claims.md").read_text(encoding="utf-8").splitlines()[2:]
    assert [line.split(" | ")[0].removeprefix("| ") for line in lines] == list(CLAIMS)
    rows = read_dataset(folder / "formulas.nc").sizes["formula"]
    assert len((folder / "formulas.csv").read_text(encoding="utf-8").splitlines()) == rows + 1


def test_snakemake_stops_at_once_with_that_line(fresh):
    # The table that a stage asks for; other mistakes are in tests/claims.
    fresh.rewrite("config/claims.yaml", "id: Table 1\n", "id: Table 2\n")
    message = "config/claims.yaml: unknown table 'Table 1'; known: Table 2"
    done = fresh.run("--cores", "1", check=False)
    assert done.returncode == 1
    said = [line for line in done.stderr.splitlines() if not line.startswith("Using ")]
    assert len(said) == 1 and said[0].startswith(message)
    assert not (fresh.path / "results").exists()


def test_a_missing_place_fails_the_stage_in_one_line(complete):
    path = complete.path / "config" / "claims.yaml"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("at: { case: 2, freq", "at: { case: 3, freq"), encoding="utf-8")
    done = complete.run("--cores", "1", "results/tally.txt", check=False)
    assert done.returncode == 1 and "Traceback" not in done.stderr
    said = [line for line in done.stderr.splitlines() if line.startswith("stage/claims: ")]
    assert len(said) == 1
    assert "fig06: apparent_restitution at case = 3" in said[0]
    assert "case = 3 is not among 0, 1, 2" in said[0]
    # The verdicts of the last good run are not taken for those of this one.
    for name in ("tally.txt", "paper.md"):
        assert not (complete.path / "results" / name).exists()


# All that a user may change at once.
OTHER = {
    ("figures", "fig03", "n"): [2],
    ("figures", "fig05", "frequency_ratio"): {"min": 2.0, "max": 50.0, "samples": 11},
    ("figures", "fig06", "cases"): [{"restitution": 0.6, "amplitude": 1.0}],
    ("figures", "fig08", "frequency_ratio"): [5.0],
    ("figures", "fig10", "amplitude"): [1.0],
    ("figures", "fig14", "n"): 2,
    ("figures", "fig14", "amplitude"): 1.4,
    ("figures", "fig15", "amplitude_max"): 1.5,
    ("figures", "fig16", "tolerance"): 0.02,
    ("figures", "fig16", "frequency_ratio"): {"min": 7.0, "max": 8.0, "samples": 11},
    ("tables", "table1", "n"): [1],
    ("tables", "table1", "frequency_ratio"): [10.0],
    ("tables", "thresholds", "tolerances"): [0.03],
    ("tables", "thresholds", "quantities"): ["max_height", "phase"],
    ("extensions", "ext_release", "n"): [2, 3],
    ("studies", "formulas", "static", "frequency_ratio"): [3.0],
    ("studies", "motions", "amplitude"): [1.0],
    ("studies", "evidence", "stiff_frequency_ratio"): 1e5,
    ("studies", "forensics", "stiff_exponents"): [4],
    ("release",): "force",
}


def asked(result):
    """The claims that are asked; the others say why they are not, and none is open."""
    there = (result.verdict != "not asked").values
    other = re.compile(r"\w+ was computed with \S+ = .*; the claim requires .*")
    assert all(other.fullmatch(text) for text in result.reason.values[~there].tolist())
    assert result.explained.values.astype(bool).all()
    return set(result.claim.values[there].tolist())


# The formulas do not depend on any of this, nor do the three routes.
ASKED_ANYWAY = {claim.id for claim in LEDGER.claims if claim.kind == "formula"} | {
    *("needs continuation", "equations cited", "frequency ratio")
}


def test_what_was_computed_with_other_parameters_is_not_asked(pristine):
    """The numbers of the run, as if they had been computed with these parameters."""
    config = copy.deepcopy(CONFIG)
    for keys, value in OTHER.items():
        section = config
        for key in keys[:-1]:
            section = section[key]
        section[keys[-1]] = value
    run = config | {"printed": LEDGER.table("Table 1")}
    data = {}
    for name in LEDGER.datasets:
        stage = STAGES[name]
        given = stage.parameters(run) | stage.settings(run) if name != "witness" else {}
        dataset = read_dataset(pristine.path / f"results/figures/{name}.nc")
        data[name] = dataset.assign_attrs(parameter_attributes(given))
    assert asked(assess(LEDGER, data)) == ASKED_ANYWAY


@pytest.mark.long
def test_a_run_with_other_parameters_does_not_ask_the_claims(complete):
    """Nothing fails, and what is left is decided."""
    for keys, value in OTHER.items():
        complete.configure(*keys, value=value)
    complete.run("--cores", "2")
    assert asked(read_dataset(complete.path / "results/figures/claims.nc")) == ASKED_ANYWAY
    assert "without explanation" not in (complete.path / "results/tally.txt").read_text("utf-8")

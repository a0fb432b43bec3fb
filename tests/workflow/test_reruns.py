"""What runs again after a change, and what does not."""

import pytest

from bouncing_ball.configuration.stages import STAGES, Kind, names

PAPER = "Writing results/paper.md"


# The figures of the corrected model.
CORRECTED = ("ext_instant", "ext_orders", "ext_validity", "ext_fig14", "ext_fig15")


def made(*names):
    """Messages of the stages that make these datasets."""
    return {f"{name}: {STAGES[name].title}" for name in names}


# Every change of a dataset that decides a claim is followed by the verdicts,
CLAIMS = {*made("claims"), "Setting claims"}
# of one that statements rest on by their evidence,
EVIDENCE = {*made("evidence"), *CLAIMS}
# and of an orbit by the comparison of the three routes, which decides one too.
WITNESS = {*made("witness"), "Setting witness", *CLAIMS}
FORENSICS = {*made("forensics"), "Setting forensics", *CLAIMS}
FORMULAS = {*made("formulas"), "Setting formulas", *CLAIMS}


def drawing(*names):
    return {f"Drawing {name}" for name in names}


@pytest.mark.parametrize(
    ("keys", "value", "expected"),
    [
        (
            ("figures", "fig08", "points"),
            101,
            {
                *made("fig08"),
                *drawing("fig08"),
                *WITNESS,
                *EVIDENCE,
            },
        ),
        (
            ("extensions", "ext_release", "restitution"),
            0.9,
            {*made("ext_release"), *drawing("ext_release"), *WITNESS, *EVIDENCE},
        ),
        (
            ("figures", "fig16", "tolerance"),
            0.02,
            {*made("fig16"), *drawing("fig16"), *EVIDENCE},
        ),
        # Decides two claims by its damping alone.
        (
            ("figures", "fig11", "restitution"),
            0.7,
            {*made("fig11"), *drawing("fig11"), *CLAIMS},
        ),
        # Decides none.
        (
            ("figures", "fig12", "amplitude"),
            1.1,
            {*made("fig12"), *drawing("fig12"), *WITNESS},
        ),
        (("studies", "formulas", "seed"), 1, FORMULAS),
        (
            ("tables", "table1", "amplitude_max"),
            1.6,
            {*made("table1"), "Setting table1", *WITNESS, *EVIDENCE},
        ),
        (
            ("continuation", "max_angle"),
            0.1,
            {
                *made("fig08", "fig09"),
                *made("fig15", "table1"),
                *drawing("fig08", "fig09", "fig15"),
                "Setting table1",
                *WITNESS,
                *EVIDENCE,
            },
        ),
    ],
)
def test_a_changed_parameter(complete, keys, value, expected):
    complete.configure(*keys, value=value)
    assert complete.planned() == expected | {PAPER}


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        (
            "studies/restitution_families.py",
            {
                *made("fig02", "fig03"),
                *drawing("fig02", "fig03"),
                *WITNESS,
                *EVIDENCE,
                PAPER,
            },
        ),
        # Every model answers for its permanent contact: with what asks models, it runs again.
        (
            "impacts/permanent_contact.py",
            {
                *made("fig07", "fig08", "fig09", "fig11", "fig12", "fig14", "fig15", "fig16"),
                *made("table1", "thresholds", "ext_release", *CORRECTED, "ext_error_law"),
                *drawing("fig07", "fig08", "fig09", "fig11", "fig12", "fig14", "fig15", "fig16"),
                *drawing("ext_release", *CORRECTED),
                "Setting table1",
                "Setting thresholds",
                "Setting ext_error_law",
                "Setting ext_validity",
                *WITNESS,
                *EVIDENCE,
                PAPER,
            },
        ),
        # Another entry is no reason to run those that are there.
        ("configuration/stages.py", set()),
        # A plotting change does not run the science again.
        ("render/figures/fig12.py", drawing("fig12")),
        (
            "render/figures/style.py",
            drawing(*names(Kind.FIGURE, Kind.EXTENSION)),
        ),
        ("render/tables/table1.py", {"Setting table1", PAPER}),
        ("audit/claims/verdict.py", {*CLAIMS, PAPER}),
        ("audit/claims/tally.py", {PAPER}),
        # Eq. 34 as printed is among the evidence.
        ("audit/formulas/as_printed.py", {*FORMULAS, *EVIDENCE, PAPER}),
    ],
)
def test_a_changed_module(complete, file, expected):
    complete.edit(file)
    assert complete.planned() == expected


def test_a_reworded_claim_runs_the_verdicts_only(complete):
    complete.rewrite("config/claims.yaml", "the greatest height rises", "the height rises")
    assert complete.planned() == {*CLAIMS, PAPER}


def test_a_printed_number_of_table_1_runs_the_table_too(complete):
    complete.rewrite("config/claims.yaml", '"1.032"', '"1.033"')
    assert complete.planned() == {
        *made("table1"),
        "Setting table1",
        *WITNESS,
        *EVIDENCE,
        *FORENSICS,
        PAPER,
    }


@pytest.mark.parametrize("targets", [(), ("fig08",)])
def test_a_dataset_that_is_missing_is_made_again(complete, targets):
    (complete.path / "results/figures/fig08.nc").unlink()
    assert made("fig08") <= complete.planned(*targets)


def test_the_modules_of_a_stage_are_those_it_imports(pristine):
    """The inputs `source` against what Python really imports."""
    import subprocess
    import sys

    code = (
        "import sys, bouncing_ball.studies.orbit_branches, bouncing_ball.pipeline.job\n"
        "print(*sorted(m.__file__ for n, m in sys.modules.items()"
        " if n.split('.')[0] == 'bouncing_ball'), sep='\\n')"
    )
    imported = subprocess.run(
        [sys.executable, "-c", code],
        env=pristine.environment(),
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    declared = subprocess.run(
        [
            sys.executable,
            "-c",
            "from bouncing_ball.pipeline.sources import sources\n"
            "print(*sources('bouncing_ball.studies.orbit_branches',"
            " 'bouncing_ball.pipeline.job'), sep='\\n')",
        ],
        env=pristine.environment(),
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    assert declared == imported

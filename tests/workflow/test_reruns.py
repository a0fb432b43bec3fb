"""What runs again after a change, and what does not."""

import pytest

PAPER = "Writing results/paper.md"
# Every change of an orbit is followed by the comparison of the three routes.
WITNESS = {"Comparing continuation, formula and simulation for witness", "Setting witness"}


def drawing(*names):
    return {f"Drawing {name}" for name in names}


@pytest.mark.parametrize(
    ("keys", "value", "expected"),
    [
        (
            ("figures", "fig06", "cases"),
            [{"restitution": 0.6, "amplitude": 1.0}],
            {"Apparent restitution for fig06", *drawing("fig06"), *WITNESS},
        ),
        (
            ("figures", "fig08", "points"),
            101,
            {"Continuation of the n-T orbits for fig08", *drawing("fig08"), *WITNESS},
        ),
        (
            ("extensions", "ext_release", "restitution"),
            0.9,
            {"Release rules for ext_release", *drawing("ext_release"), *WITNESS},
        ),
        (
            ("figures", "fig16", "tolerance"),
            0.02,
            {"Error thresholds for fig16", *drawing("fig16")},
        ),
        (
            ("tables", "table1", "amplitude_max"),
            1.6,
            {"Continuation of the n-T orbits for table1", "Setting table1", *WITNESS},
        ),
        (
            ("studies", "forensics", "steps"),
            [0.01],
            {"Readings of Table 1 for forensics", "Setting forensics"},
        ),
        (
            ("continuation", "max_angle"),
            0.1,
            {
                *(f"Continuation of the n-T orbits for {x}" for x in ("fig08", "fig09")),
                *(f"Continuation of the n-T orbits for {x}" for x in ("fig15", "table1")),
                *drawing("fig08", "fig09", "fig15"),
                "Setting table1",
                *WITNESS,
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
            "studies/restitution_orbits.py",
            {
                *(f"Orbits of the restitution model for {x}" for x in ("fig02", "fig03")),
                *drawing("fig02", "fig03"),
                *WITNESS,
                PAPER,
            },
        ),
        # The table of thresholds and Figs. 14 and 16 use the permanent contact too.
        (
            "models/permanent_contact.py",
            {
                "Permanent contact threshold for fig11",
                *(f"Error thresholds for {x}" for x in ("fig14", "fig16", "thresholds")),
                "Release rules for ext_release",
                *drawing("fig11", "fig14", "fig16", "ext_release"),
                "Setting thresholds",
                *WITNESS,
                PAPER,
            },
        ),
        (
            "studies/forensics/readings.py",
            {"Readings of Table 1 for forensics", "Setting forensics", PAPER},
        ),
        # A plotting change does not run the science again.
        ("figures/fig12.py", drawing("fig12")),
        (
            "figures/branches.py",
            drawing(*(f"fig{k:02d}" for k in (3, 5, 6, 8, 9, 10, 13, 14, 15))),
        ),
        ("figures/style.py", drawing("ext_release", *(f"fig{k:02d}" for k in range(1, 17)))),
        ("tables/table1.py", {"Setting table1", PAPER}),
    ],
)
def test_a_changed_module(complete, file, expected):
    complete.edit(file)
    assert complete.planned() == expected


def test_the_modules_of_a_stage_are_those_it_imports(pristine):
    """The inputs `source` against what Python really imports."""
    import subprocess
    import sys

    code = (
        "import sys, bouncing_ball.studies.continuation, bouncing_ball.pipeline.job\n"
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
            "print(*sources('bouncing_ball.studies.continuation',"
            " 'bouncing_ball.pipeline.job'), sep='\\n')",
        ],
        env=pristine.environment(),
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    assert declared == imported

"""A piece that is missing is named before anything runs."""

from dataclasses import replace
from pathlib import Path

import pytest

from bouncing_ball.configuration.stages import ENTRIES, STAGES
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml
from bouncing_ball.pipeline.pieces import check_entries, check_pieces

CONFIG = Path(__file__).resolve().parents[2] / "config"
RUN = read_yaml(CONFIG / "config.yaml")
NEW = replace(STAGES["fig08"], name="fig17", title="Figure 17: new")


def test_nothing_is_missing():
    check_entries(ENTRIES)
    check_pieces(STAGES, RUN)


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (replace(NEW, name="fig08"), "fig08: two entries have this name"),
        (
            replace(NEW, arguments="release"),
            "fig17: arguments='release' must be a tuple: arguments=('release',)",
        ),
        (replace(NEW, reads="fig08"), "fig17: reads='fig08' must be a tuple: reads=('fig08',)"),
    ],
)
def test_an_entry_that_would_be_misread(one_line, entry, said):
    with pytest.raises(ConfigurationError) as error:
        check_entries([*ENTRIES, entry])
    one_line(error, said)


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        (NEW, "fig17: no drawing in DRAWINGS of src/bouncing_ball/figures/__init__.py"),
        (replace(NEW, name="fig16", study="studies.sweeps.f"), "no module src/bouncing_ball/stud"),
        (
            replace(NEW, name="fig16", study="studies.orbit_branches.sweep"),
            "fig16: no function sweep in src/bouncing_ball/studies/orbit_branches",
        ),
        (
            replace(NEW, name="fig16", section="figures.fig17"),
            "fig16: no section figures.fig17 in config/config.yaml",
        ),
        (replace(NEW, name="fig16", arguments=("tolerance",)), "fig16: unknown setting tolerance"),
        (replace(NEW, name="fig16", reads=("fig19",)), "fig16: it reads an unknown dataset fig19"),
        (replace(NEW, name="fig16", reads=("fig01",)), "fig16: it reads an unknown dataset fig01"),
        (
            replace(NEW, name="fig16", arguments=("release",)),
            "orbit_branches takes (parameters, release, continuation), its entry gives (parameters",
        ),
        (
            replace(NEW, name="fig16", reads=("fig08",)),
            "orbit_branches takes (parameters, release, continuation), its entry gives (data",
        ),
    ],
)
def test_an_entry_without_a_piece(one_line, entry, said):
    with pytest.raises(ConfigurationError) as error:
        check_pieces(STAGES | {entry.name: entry}, RUN)
    one_line(error, said)


def test_parameters_without_an_entry(one_line):
    entries = {name: stage for name, stage in STAGES.items() if name != "ext_basins"}
    with pytest.raises(ConfigurationError) as error:
        check_pieces(entries, RUN)
    one_line(
        error, "extensions.ext_basins has no entry in src/bouncing_ball/configuration/stages.py"
    )

"""The indexes of equations and of figures lead to modules that exist."""

import re
from importlib.util import find_spec

import pytest
from declared_artifacts import ARTIFACTS

import bouncing_ball.paper
import bouncing_ball.paper.exhibits


@pytest.mark.parametrize("package", [bouncing_ball.paper, bouncing_ball.paper.exhibits])
def test_each_module_of_an_index_exists(package):
    named = re.findall(r":mod:`(\.[\w.]+)`", package.__doc__)
    missing = [name for name in named if find_spec(name, package.__name__) is None]
    assert len(named) > 8 and not missing


def test_the_index_of_figures_has_every_figure_and_the_table():
    index = bouncing_ball.paper.exhibits.__doc__
    rows = re.findall(r"^Fig\. ([\d, ]+?)  *:mod:", index, flags=re.M)
    figures = sorted(int(number) for row in rows for number in row.split(","))
    assert figures == list(range(1, 17)) and "Table 1" in index


def test_the_index_of_figures_leads_to_the_stage_that_makes_each_figure():
    index = bouncing_ball.paper.exhibits.__doc__
    for row, module in re.findall(r"^Fig\. ([\d, ]+?)  *:mod:`\.(\w+)`", index, flags=re.M):
        for number in row.split(","):
            artifact = ARTIFACTS[f"fig{int(number):02d}"]
            # The schematics have pictures only.
            expected = artifact.module if artifact.study else artifact.figures
            assert expected == f"paper.exhibits.{module}"


def test_no_artifact_of_the_paper_reads_a_dataset_of_the_second_wing():
    read = {name for each in ARTIFACTS.values() if each.wing == "paper" for name in each.reads}
    assert read and {ARTIFACTS[name].wing for name in read} == {"paper"}

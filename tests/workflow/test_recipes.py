"""The recipes of CONTRIBUTING, each tried on a fresh clone with exactly the files that it names."""

from bouncing_ball.pipeline.provenance import read_provenance

STAGES = "workflow/rules/study.smk"
READS = "workflow/artifacts.yaml"
CONFIG = "config/config.yaml"
FIGURE = "src/bouncing_ball/figures/heights.py"
STAGE = "src/bouncing_ball/paper/exhibits/lowest.py"


def changed(tree):
    """The files that differ from the commit."""
    return {line.split()[-1] for line in tree.git("status", "--porcelain").splitlines()}


FIRST = '            ext_release="'
ENTRY = '            ext_heights="paper.exhibits.apparent_restitution.frequency_sweep -> heights.heights",\n'
PARAMETERS = """  ext_heights:
    n: 1
    restitution: 0.85
    amplitude: [0.9]
    frequency_ratio: { min: 5.0, max: 50.0, samples: 21 }

studies:
  formulas:"""
DRAWING = '''"""Greatest height along ϖ."""

import matplotlib.pyplot as plt
import xarray as xr
from matplotlib.figure import Figure


def heights(data: xr.Dataset) -> Figure:
    """The figure."""
    figure, axes = plt.subplots()
    axes.semilogx(data.frequency_ratio, data.max_height[0])
    axes.set(xlabel="frequency ratio", ylabel="greatest height")
    return figure
'''


STUDY = '''"""A number from the curve of another stage."""

from collections.abc import Mapping

import xarray as xr

from bouncing_ball.datasets.variables import described
from bouncing_ball.datasets.parameters import Family, Parameters


class Lowest(Parameters):
    """How many thresholds are looked at."""

    n: Family


def lowest(data: Mapping[str, xr.Dataset], parameters: Lowest) -> xr.Dataset:
    """The lowest of the first ``n`` thresholds."""
    curve = data["fig11"].threshold_amplitude[: parameters.n]
    return described({"threshold_amplitude": curve.min()})
'''


def test_a_figure_with_its_own_parameters_and_a_stage_on_the_dataset_of_another(fresh):
    fresh.rewrite(STAGES, FIRST, ENTRY + FIRST)
    assert fresh.refusal().startswith(
        "configuration: ext_heights has no parameters: add a key ext_heights"
    )
    fresh.rewrite(CONFIG, "studies:\n  formulas:", PARAMETERS)
    (fresh.path / FIGURE).write_text(DRAWING, encoding="utf-8")
    assert changed(fresh) == {STAGES, CONFIG, FIGURE}
    (fresh.path / STAGE).write_text(STUDY, encoding="utf-8")
    fresh.rewrite(STAGES, FIRST, '            ext_lowest="paper.exhibits.lowest.lowest",\n' + FIRST)
    fresh.rewrite(READS, "ext_release:\n", "ext_lowest: { reads: [fig11] }\next_release:\n")
    lowest = "studies:\n  ext_lowest: { n: 110 }\n  formulas:"
    fresh.rewrite(CONFIG, "studies:\n  formulas:", lowest)
    assert changed(fresh) == {STAGES, READS, CONFIG, FIGURE, STAGE}
    assert fresh.refusal().startswith(
        "configuration: studies.ext_lowest.n = 110 must be at most 20"
    )
    fresh.rewrite(CONFIG, "ext_lowest: { n: 110 }", "ext_lowest: { n: 11 }")
    fresh.run("--cores", "1", "ext_heights", "ext_lowest")
    made = {path.name: path for path in (fresh.path / "results/figures").iterdir()}
    figure = {f"ext_heights.{kind}" for kind in ("nc", "png", "svg")}
    assert made.keys() == {*figure, "fig11.nc", "ext_lowest.nc"}
    # The tree has changes that its commit has not.
    assert {read_provenance(path)["dirty"] for path in made.values()} == {"yes"}


def test_a_parameter(fresh):
    fresh.rewrite(
        "src/bouncing_ball/paper/exhibits/permanent_contact.py",
        "    frequency_ratio: Span\n",
        "    frequency_ratio: Span\n    load: Tolerance\n",
    )
    fresh.rewrite(
        "src/bouncing_ball/paper/exhibits/permanent_contact.py",
        "import Parameters, Restitution, Span",
        "import Parameters, Restitution, Span, Tolerance",
    )
    fresh.rewrite(CONFIG, "fig11: # permanent-contact threshold", "fig11:\n    load: 2.0")
    assert fresh.refusal().startswith("configuration: figures.fig11.load = 2.0 must be less than 1")

"""The recipes of CONTRIBUTING, each tried on a fresh clone with exactly the files that it names."""

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.provenance import read_provenance

PAPER = "workflow/rules/paper.smk"
CONFIG = "config/config.yaml"
EXHIBITS = "src/bouncing_ball/paper/exhibits"
FIGURES = f"{EXHIBITS}/apparent_restitution_figures.py"
STAGE = f"{EXHIBITS}/lowest.py"


def changed(tree):
    """The files that differ from the commit."""
    return {line.split()[-1] for line in tree.git("status", "--porcelain").splitlines()}


FIRST = "            fig05=dict("
ENTRY = """            heights=dict(
                title="Greatest height", study="frequency_sweep", drawing="heights"
            ),
"""
PARAMETERS = """paper:
  heights:
    n: 1
    restitution: 0.85
    amplitude: [0.9]
    frequency_ratio: { min: 5.0, max: 50.0, samples: 21 }

"""
DRAWING = '''

def heights(data: xr.Dataset) -> Figure:
    """The greatest height along ϖ."""
    figure, axes = canvas()
    axes.semilogx(data.frequency_ratio, data.max_height[0])
    axes.set(xlabel="frequency ratio", ylabel="greatest height")
    return figure
'''


RULE = """use rule study as lowest_study with:
    wildcard_constraints:
        artifact=stage(
            "bouncing_ball.paper.exhibits.lowest",
            threshold=dict(title="Lowest threshold", study="lowest", reads=("fig11",)),
        ),


"""
STUDY = '''"""A number from the curve of another stage."""

from collections.abc import Mapping

import xarray as xr

from bouncing_ball.datasets.parameters import Family, Parameters
from bouncing_ball.datasets.variables import Variable, described

VARIABLES = {"lowest_amplitude": Variable("lowest threshold", symbol="Λ")}


class Lowest(Parameters):
    """How many thresholds are looked at."""

    n: Family


def lowest(data: Mapping[str, xr.Dataset], parameters: Lowest) -> xr.Dataset:
    """The lowest of the first ``n`` thresholds."""
    curve = data["fig11"].threshold_amplitude[: parameters.n]
    return described({"lowest_amplitude": ((), float(curve.min()))}, variables=VARIABLES)
'''


def test_a_figure_and_a_stage_on_the_dataset_of_another_need_the_files_of_the_recipes_only(fresh):
    fresh.rewrite(PAPER, FIRST, ENTRY + FIRST)
    assert fresh.refusal().startswith("configuration: missing key paper.heights: ")
    fresh.rewrite(CONFIG, "paper:\n", PARAMETERS)
    with (fresh.path / FIGURES).open("a", encoding="utf-8") as module:
        module.write(DRAWING)
    assert changed(fresh) == {PAPER, CONFIG, FIGURES}
    (fresh.path / STAGE).write_text(STUDY, encoding="utf-8")
    first = "use rule study as permanent_contact_study with:"
    fresh.rewrite(PAPER, first, RULE + first)
    fresh.rewrite(CONFIG, "paper:\n", "paper:\n  threshold: { n: 110 }\n")
    assert changed(fresh) == {PAPER, CONFIG, FIGURES, STAGE}
    assert fresh.refusal().startswith("configuration: paper.threshold.n = 110 must be at most 20")
    fresh.rewrite(CONFIG, "threshold: { n: 110 }", "threshold: { n: 11 }")
    # The stage has the name of its module, and the figure its own.
    fresh.run("--cores", "1", "heights", "lowest")
    made = {path.name: path for path in fresh.path.glob("results/figures/**/*.*")}
    figure = {f"heights.{kind}" for kind in ("nc", "png", "svg")}
    assert made.keys() == {*figure, "fig11.nc", "threshold.nc"}
    assert read_dataset(made["threshold.nc"]).lowest_amplitude.long_name == "lowest threshold"
    # The tree has changes that its commit has not.
    assert {read_provenance(path)["dirty"] for path in made.values()} == {"yes"}


def test_a_parameter_needs_a_line_beside_its_study_and_a_value(fresh):
    module = f"{EXHIBITS}/permanent_contact.py"
    fresh.rewrite(
        module,
        "    restitution: Restitution\n    frequency_ratio: Span\n",
        "    restitution: Restitution\n    frequency_ratio: Span\n    load: Tolerance\n",
    )
    fresh.rewrite(CONFIG, "fig11: # permanent-contact threshold", "fig11:\n    load: 2.0")
    said = fresh.run("--cores", "1", check=False).stderr
    assert "configuration: paper.fig11.load = 2.0 must be less than 1" in said
    # The study of another figure has the same parameters.
    assert "missing key paper.fig16.load" in said

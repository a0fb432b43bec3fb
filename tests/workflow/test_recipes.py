"""The recipes of CONTRIBUTING, each tried on a fresh clone with exactly the files that it names."""

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.provenance import read_provenance

RULES = "workflow/rules"
SCRIPTS = "workflow/scripts"
PAPER = "src/bouncing_ball/paper"
CONFIG = "config/config.yaml"
EXHIBITS = "src/bouncing_ball/paper/exhibits"
FIGURES = f"{EXHIBITS}/apparent_restitution_figures.py"
STAGE = f"{EXHIBITS}/lowest.py"


def changed(tree):
    """The files that differ from the commit."""
    return {line.split()[-1] for line in tree.git("status", "--porcelain").splitlines()}


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


RULE = """rule compute_threshold:
    message:
        "Computing threshold"
    input:
        code=code("compute_threshold.py"),
        data=["results/figures/fig11.nc"],
    output:
        "results/figures/threshold.nc",
    params:
        artifact=about("threshold"),
        parameters=config["paper"]["threshold"],
    log:
        "results/logs/compute_threshold.log",
    run:
        work("compute_threshold.py", rule, input, output, params, log)


"""
SCRIPT = '''"""A number from the curve of another stage."""

from bouncing_ball.paper.exhibits.lowest import lowest
from bouncing_ball.pipeline.job import logged, make_dataset

with logged(snakemake):
    make_dataset(snakemake, lowest)
'''
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


def copy_of(text, *names):
    """Rules of a text for the new figure, in which they have its name."""
    rules = {rule.split(":")[0]: rule.strip() for rule in text.split("\nrule ")[1:]}
    part = "\n\n\n".join(f"rule {rules[name]}" for name in names)
    return part.replace("fig10", "heights").replace("Figure 10", "The greatest height")


def copied(tree, script, new):
    """A script of another name with the content of one that there is."""
    text = (tree.path / script).read_text(encoding="utf-8")
    (tree.path / new).write_text(text, encoding="utf-8")


def test_a_figure_needs_the_files_of_its_recipe_only(fresh):
    artifacts = f"{PAPER}/artifacts.py"
    drawn = "apparent_restitution_figures:heights"
    heights = f'    Artifact("heights", "Greatest height", f"{{_EXHIBITS}}.{drawn}"),\n'
    fresh.rewrite(artifacts, "by_name(\n", f"by_name(\n{heights}")
    types = f"{PAPER}/configuration.py"
    fresh.rewrite(types, "    fig10: Sweep\n", "    fig10: Sweep\n    heights: Sweep\n")
    said = fresh.run("--cores", "1", check=False).stderr
    assert "but code has: src/bouncing_ball/paper/artifacts.py, " in said
    assert "\nconfiguration: missing key paper.heights: " in said
    fresh.rewrite(CONFIG, "paper:\n", PARAMETERS)
    compute = f"{SCRIPTS}/compute_heights.py"
    copied(fresh, f"{SCRIPTS}/compute_fig10.py", compute)
    datasets = fresh.path / RULES / "datasets.smk"
    text = datasets.read_text(encoding="utf-8")
    rule = copy_of(text, "compute_fig10")
    datasets.write_text(f"{text}\n\n{rule.strip()}\n", encoding="utf-8")
    with (fresh.path / FIGURES).open("a", encoding="utf-8") as module:
        module.write(DRAWING)
    pictures = fresh.path / RULES / "figures.smk"
    text = pictures.read_text(encoding="utf-8")
    rules = copy_of(text, "draw_fig10", "fig10")
    pictures.write_text(f"{text}\n\n{rules.strip()}\n", encoding="utf-8")
    draw = f"{SCRIPTS}/draw_heights.py"
    copied(fresh, f"{SCRIPTS}/draw_fig10.py", draw)
    text = (fresh.path / draw).read_text(encoding="utf-8")
    (fresh.path / draw).write_text(text.replace("bounce_velocity", "heights"), encoding="utf-8")
    caption = "workflow/report/heights.rst"
    (fresh.path / caption).write_text("The greatest height.", encoding="utf-8")
    targets = f"{RULES}/targets.smk"
    line = "        rules.fig10.input,\n"
    fresh.rewrite(targets, line, line + line.replace("fig10", "heights"))
    rules = {f"{RULES}/{each}.smk" for each in ("datasets", "figures", "targets")}
    assert changed(fresh) == rules | {artifacts, types, CONFIG, FIGURES, compute, draw, caption}
    fresh.run("--cores", "1", "heights")
    made = {path.name: path for path in fresh.path.glob("results/figures/*.*")}
    assert made.keys() == {f"heights.{kind}" for kind in ("nc", "png", "svg")}
    # The tree has changes that its commit has not.
    assert {read_provenance(path)["dirty"] for path in made.values()} == {"yes"}
    # It is part of a whole run.
    assert "results/figures/heights.png" in fresh.planned_files()


def test_a_study_on_the_dataset_of_another_needs_the_files_of_its_recipe_only(fresh):
    artifacts = f"{PAPER}/artifacts.py"
    threshold = '    Artifact("threshold", "Lowest threshold"),\n'
    fresh.rewrite(artifacts, "by_name(\n", f"by_name(\n{threshold}")
    types = f"{PAPER}/configuration.py"
    imported = "from bouncing_ball.paper.exhibits.lowest_period"
    lowest = "from bouncing_ball.paper.exhibits.lowest import Lowest\n"
    fresh.rewrite(types, imported, lowest + imported)
    fresh.rewrite(
        types, "    formulas: Formulas\n", "    formulas: Formulas\n    threshold: Lowest\n"
    )
    (fresh.path / STAGE).write_text(STUDY, encoding="utf-8")
    script = f"{SCRIPTS}/compute_threshold.py"
    (fresh.path / script).write_text(SCRIPT, encoding="utf-8")
    datasets = f"{RULES}/datasets.smk"
    first = "rule compute_fig11:"
    fresh.rewrite(datasets, first, RULE + first)
    fresh.rewrite(CONFIG, "paper:\n", "paper:\n  threshold: { n: 110 }\n")
    assert changed(fresh) == {artifacts, types, STAGE, script, datasets, CONFIG}
    assert fresh.refusal().startswith("configuration: paper.threshold.n = 110 must be at most 20")
    fresh.rewrite(CONFIG, "threshold: { n: 110 }", "threshold: { n: 11 }")
    fresh.run("--cores", "1", "results/figures/threshold.nc")
    data = read_dataset(fresh.path / "results/figures/threshold.nc")
    assert data.lowest_amplitude.long_name == "lowest threshold"
    assert data.attrs["title"] == "Lowest threshold"


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

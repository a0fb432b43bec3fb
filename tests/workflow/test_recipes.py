"""The recipes of CONTRIBUTING, each tried on a fresh clone."""

ENTRY = """    Stage(
        "ext_heights",
        Kind.EXTENSION,
        "Greatest height along the frequency ratio",
        "studies.frequency_sweeps.frequency_sweep",
        "extensions.ext_heights",
        "n restitution amplitude:amplitudes frequency_ratio:span",
        ("release",),
    ),
)

_EXPLORER"""
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
STAGES = "src/bouncing_ball/configuration/stages.py"
CONFIG = "config/config.yaml"
FIGURE = "src/bouncing_ball/figures/heights.py"
DRAWINGS = "src/bouncing_ball/figures/__init__.py"


def said(tree, *arguments):
    """The one line with which a run is refused before anything runs."""
    done = tree.run("--cores", "1", *arguments, check=False)
    assert done.returncode == 1
    (line,) = [x for x in done.stderr.splitlines() if not x.startswith("Using ")]
    return line


def test_a_figure_with_its_own_parameters(fresh):
    # Four files, and until the last is there the missing piece is named.
    fresh.rewrite(STAGES, ")\n\n_EXPLORER", ENTRY)
    assert said(fresh) == "configuration: missing key extensions.ext_heights"
    fresh.rewrite(CONFIG, "studies:\n  formulas:", PARAMETERS)
    assert said(fresh) == f"stages: ext_heights: no drawing in DRAWINGS of {DRAWINGS}"
    fresh.rewrite(DRAWINGS, "DRAWINGS = {", 'DRAWINGS = {\n    "ext_heights": "heights.heights",')
    assert said(fresh).startswith(f"stages: ext_heights: no module {FIGURE}")
    (fresh.path / FIGURE).write_text(DRAWING, encoding="utf-8")
    changed = fresh.git("status", "--porcelain").splitlines()
    assert {line.split()[-1] for line in changed} == {STAGES, CONFIG, FIGURE, DRAWINGS}
    fresh.run("--cores", "1", "ext_heights")
    kinds = {path.suffix for path in (fresh.path / "results/figures").glob("ext_heights.*")}
    assert kinds == {".nc", ".png", ".svg"}


STUDY = '''"""A number from the curve of another stage."""

from collections.abc import Mapping
from typing import Any

import xarray as xr


def lowest(data: Mapping[str, xr.Dataset], parameters: Mapping[str, Any]) -> xr.Dataset:
    """The lowest of the first ``n`` thresholds."""
    curve = data["fig11"].threshold_amplitude[: parameters["n"]]
    return xr.Dataset({"threshold_amplitude": curve.min()})
'''


def test_a_stage_on_the_dataset_of_another(fresh):
    (fresh.path / "src/bouncing_ball/studies/lowest.py").write_text(STUDY, encoding="utf-8")
    entry = """_AUDIT = (
    Stage(
        "lowest",
        Kind.DATASET,
        "Lowest threshold of permanent contact",
        "studies.lowest.lowest",
        "studies.lowest",
        "n",
        reads=("fig11",),
    ),"""
    fresh.rewrite(STAGES, "_AUDIT = (", entry)
    fresh.rewrite(CONFIG, "studies:\n  formulas:", "studies:\n  lowest: { n: 11 }\n  formulas:")
    fresh.run("--cores", "1", "lowest")
    made = {path.name for path in (fresh.path / "results/figures").iterdir()}
    assert made == {"fig11.nc", "lowest.nc"}


KIND = """  load:
    description: weight of the ball against that of the paper, from 1 to 10
    type: number
    minimum: 1
    maximum: 10

properties:
  release:"""


def test_a_parameter(fresh):
    fresh.rewrite("config/schema.yaml", "\nproperties:\n  release:", KIND)
    fresh.rewrite(
        STAGES,
        '"restitution:damped_restitution frequency_ratio:span",',
        '"restitution:damped_restitution frequency_ratio:span load",',
    )
    assert said(fresh) == "configuration: missing key figures.fig11.load"
    fresh.rewrite(CONFIG, "fig11: # permanent-contact threshold", "fig11:\n    load: 0.5")
    assert said(fresh).startswith("configuration: figures.fig11.load = 0.5 must be at least 1")
    fresh.rewrite(CONFIG, "load: 0.5", "load: 2.0")
    assert any(job.startswith("fig11: ") for job in fresh.planned("fig11"))

"""Another paper, replicated with `paper_replication`: how long a swing of a pendulum takes.

The paper, which is invented, prints 2.15 s for 1 m and 60°, and says that the formula of small
swings is right within 1 % up to 20°. The period is T = 2π √(l/g) / agm(1, cos(θ/2)).
"""

import shutil
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from scipy.special import agm
from tests.jobs import Named

from paper_replication import compare, datasets, drawing, judgements, origins, provenance
from paper_replication.datasets import Variable
from paper_replication.templates import environment
from paper_replication.verdicts import Claim, within

VARIABLES = {
    "angle": Variable("angle of the release", "θ", units="deg"),
    "period": Variable("period", "T", "Eq. 1", "s"),
}
FIG1 = {"title": "Figure 1: period of a pendulum", "length": 1.0}
SENTENCE = "At 60° a swing takes {{ fig1.period.sel(angle=60).item() | fixed(2) }} s."


def period(given, gravity):
    """The stage."""
    angle = xr.DataArray(np.arange(91.0), dims="angle")
    small = 2 * np.pi * np.sqrt(given["length"] / gravity)
    return xr.Dataset({"period": small / agm(1, np.cos(np.radians(angle) / 2)), "angle": angle})


def draw(name, data, folder):
    """The figure."""
    figure, axes = drawing.panels(2.0)
    axes.plot(data.angle, data.period, color=drawing.COLOURS[1])
    axes.set(xlabel="angle θ in degrees", ylabel="period T in s")
    drawing.save_picture(figure, folder / f"{name}.png", folder / f"{name}.svg")


def small_swings(fig1):
    error = fig1.period.sel(angle=slice(20)) / fig1.period[0] - 1
    return [within("the relative error up to 20°", error, 0.01)]


CLAIMS = [
    Claim("sixty", "Table 1", "60°", {"fig1": {}}, lambda fig1: fig1.period[60].item(), "2.15"),
    Claim("small", "Conclusion", "small swings", {"fig1": {"length": 1.0}}, small_swings),
]


def job(top, rule, data=(), **made):
    """What Snakemake gives to the script of a rule."""
    return SimpleNamespace(
        input=SimpleNamespace(code=[str(top / "src/pendulum.py")], data=data),
        output=Named(**made, record=str(top / f"results/records/{rule}.json")),
        params=SimpleNamespace(entries={"fig1": FIG1}),
    )


def run(top, gravity=9.81):
    """One run of the workflow: a stage and a figure."""
    folder = top / "results/figures"
    stage = job(top, "periods", fig1=f"{folder}/fig1.nc")
    stage.params.settings = {"gravity": gravity, "unused": True}
    datasets.save_stage({"fig1": period}, stage, lambda name: VARIABLES, "An invented paper")
    draw("fig1", datasets.read(stage.output.fig1), folder)
    pictures = {"png": f"{folder}/fig1.png", "svg": f"{folder}/fig1.svg"}
    datasets.save_record(job(top, "fig1", stage.output.fig1, **pictures))
    return datasets.read(stage.output.fig1)


@pytest.fixture
def top(tmp_path, monkeypatch):
    """A checkout whose only code is this file."""
    monkeypatch.setattr(provenance, "CHECKOUT", tmp_path)
    (tmp_path / "src").mkdir()
    shutil.copy(__file__, tmp_path / "src/pendulum.py")
    return tmp_path


def test_a_dataset_a_claim_and_a_sentence(top):
    fig1 = run(top)
    assert datasets.parameters(fig1) == {"length": 1.0, "gravity": 9.81}
    assert (judgements.judged({"fig1": fig1}, CLAIMS, [], "").verdict == "reproduced").all()
    text = environment(top, marked=True).from_string(SENTENCE).render(fig1=fig1)
    assert origins.bare(text) == "At 60° a swing takes 2.15 s."
    assert [*origins.origins(SENTENCE, ["fig1"], {})[0].datasets] == ["fig1"]


def test_runs_are_compared(top):
    project = compare.Project(top, (), draw, ("src",), lambda name: VARIABLES)
    run(top)
    shutil.copytree(top / "results", top / "earlier")
    run(top, gravity=9.80665)
    runs = [compare.run_in(top / each, each) for each in ("earlier", "results")]
    (line,) = compare.compare(project, *runs).lines()
    assert "fig1: period 2" in line and line.endswith("parameter: gravity 9.81 → 9.80665")

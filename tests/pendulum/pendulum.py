"""Another paper, replicated with `paper_replication`: how long a swing of a pendulum takes.

The paper, which is invented, prints 2.15 s for 1 m and 60°, and says that the formula of small
swings is right within 1 % up to 20°. The period is T = 2π √(l/g) / agm(1, cos(θ/2)).
"""

from pathlib import Path

import numpy as np
import xarray as xr
from scipy.special import agm

from paper_replication import drawing
from paper_replication.datasets import Project, Variable
from paper_replication.judgements import NOTHING
from paper_replication.verdicts import Claim, within

VARIABLES = {
    "angle": Variable("angle of the release", "θ", units="deg"),
    "period": Variable("period", "T", "Eq. 1", "s"),
    **{name: Variable(name) for name in NOTHING},
}
PAGES = {"index.html": "Results", "paper.html": "Article", "numbers.html": "Numbers"}
TEXT = """# The period of a pendulum

At 60° a swing takes {{ fig1.period.sel(angle=60).item() | fixed(2) }} s. The period is

$$T = \\frac{2\\pi\\sqrt{l/g}}{\\mathrm{agm}(1, \\cos(\\theta/2))}. \\qquad (1)$$

![Figure 1](figures/fig1.png)
**Figure 1.** Period by angle.
"""


def period(given, gravity):
    """The stage."""
    angle = xr.DataArray(np.arange(91.0), dims="angle")
    small = 2 * np.pi * np.sqrt(given["length"] / gravity)
    return xr.Dataset({"period": small / agm(1, np.cos(np.radians(angle) / 2)), "angle": angle})


@drawing.style()
def draw(data):
    """The figure."""
    figure, axes = drawing.panels(2.0)
    axes.plot(data.angle, data.period, color=drawing.COLOURS[1])
    axes.set(xlabel="angle θ in degrees", ylabel="period T in s")
    return figure


def save_drawn(name, data, folder):
    """The files of the figure, if a dataset has one."""
    if name == "fig1":
        drawing.save_picture(draw(data), folder / f"{name}.png", folder / f"{name}.svg", "pendulum")


def small_swings(fig1):
    error = fig1.period.sel(angle=slice(20)) / fig1.period[0] - 1
    return [within("the relative error up to 20°", error, 0.01)]


CLAIMS = [
    Claim("sixty", "Table 1", "60°", {"fig1": {}}, lambda fig1: fig1.period[60].item(), "2.15"),
    Claim("small", "Conclusion", "small swings", {"fig1": {"length": 1.0}}, small_swings),
]

TOP = Path(__file__).parent
PROJECT = Project(
    top=TOP,
    checkout=TOP,
    code=("Snakefile", "config", "pendulum.py"),
    texts=("paper.md",),
    references="An invented paper",
    source="pendulum",
    license="BSD-3-Clause",
    describe=lambda name: VARIABLES,
    described_in=("pendulum.py",),
    side_by_side=lambda name, several: drawing.on_the_same_axes([*map(draw, several)]),
    make=save_drawn,
)

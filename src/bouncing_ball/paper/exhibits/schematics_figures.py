"""Figures 1 and 4: schematics of the two models."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle

from bouncing_ball.drawing.canvas import canvas
from bouncing_ball.drawing.style import ARROW, GUIDE, Look

_LINE: Look = {"color": "black", "linewidth": 1.0, "solid_capstyle": "round"}


def restitution_model() -> Figure:
    """Fig. 1: the ball in flight above the table, without contact elements."""
    figure, axes = _scene(2.6, (-0.56, 4.42), 2.7, 2.7, r"$a\,\sin(\Omega t)$")
    axes.plot([1.7, 1.7], [1.0, 2.28], **GUIDE)
    axes.text(1.8, 1.2, "impact: $r$", ha="left", va="center", fontsize=8)
    return figure


def spring_damper_model() -> Figure:
    """Fig. 4: the ball over a spring and a dashpot that stand on the table."""
    figure, axes = _scene(2.8, (-0.58, 4.91), 2.95, 2.75, r"$a\,\sin(\Omega t+\varphi)$")
    axes.plot([1.15, 2.25], [2.3, 2.3], **_LINE)
    _spring(axes, 1.35, 1.0, 2.3)
    _damper(axes, 2.05, 1.0, 2.3)
    axes.text(1.08, 1.65, "$k$", ha="right", va="center")
    axes.text(2.32, 1.65, "$c$", ha="left", va="center")
    return figure


def _scene(
    width: float, span: tuple[float, float], ball: float, low: float, motion: str
) -> tuple[Figure, Axes]:
    """The ball, the moving table, and arrows of y(t) and g that start at the height ``low``."""
    figure, axes = canvas(width, 1.5)
    axes.set(xlim=span, ylim=(0.4, low + 0.75), aspect="equal")
    axes.axis("off")
    body: Look = {"edgecolor": "black", "linewidth": 1.0}
    axes.add_patch(Circle((1.7, ball), 0.42, facecolor="#d9d9d9", **body))
    axes.text(1.7, ball, "$m$", ha="center", va="center")
    axes.add_patch(Rectangle((0.5, 0.55), 2.4, 0.45, facecolor="white", hatch="////", **body))
    axes.text(0.36, 0.78, r"$M=\infty$", ha="right", va="center")
    for start, end, heads, (x, y, side), name in (
        ((2.6, low), (2.6, low + 0.65), "-|>", (2.72, low + 0.32, "left"), "$y(t)$"),
        ((3.1, 0.55), (3.1, 1.25), "<|-|>", (3.25, 0.9, "left"), motion),
        ((0.75, low + 0.65), (0.75, low), "-|>", (0.65, low + 0.32, "right"), "$g$"),
    ):
        axes.annotate("", xy=end, xytext=start, arrowprops=ARROW | {"arrowstyle": heads})
        axes.text(x, y, name, ha=side, va="center")
    return figure, axes


def _spring(axes: Axes, x: float, y0: float, y1: float) -> None:
    lead = 0.15 * (y1 - y0)
    zigzag = np.linspace(y0 + lead, y1 - lead, 11)
    offset = 0.16 * np.array([0, 0, *[1, -1] * 4, 1, 0, 0])
    axes.plot(x + offset, [y0, *zigzag, y1], **_LINE)


def _damper(axes: Axes, x: float, y0: float, y1: float) -> None:
    low, piston, high = (y0 + share * (y1 - y0) for share in (0.3, 0.5, 0.68))
    for xs, ys in (
        ([0, 0], [y0, low]),
        ([-0.17, -0.17, 0.17, 0.17], [high, low, low, high]),
        ([-0.1275, 0.1275], [piston, piston]),
        ([0, 0], [piston, y1]),
    ):
        axes.plot(x + np.array(xs), ys, **_LINE)

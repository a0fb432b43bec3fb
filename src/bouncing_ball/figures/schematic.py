"""Parts of the two schematics (Figs. 1 and 4)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle

from bouncing_ball.figures.style import Look

LINE: Look = {"color": "black", "linewidth": 1.0, "solid_capstyle": "round"}


def blank(axes: Axes, width: tuple[float, float], height: tuple[float, float]) -> None:
    """Axes in plain coordinates, without frame."""
    axes.set(xlim=width, ylim=height, aspect="equal")
    axes.axis("off")


def ball(axes: Axes, x: float, y: float, radius: float) -> None:
    """The ball, with its mass."""
    axes.add_patch(Circle((x, y), radius, facecolor="#d9d9d9", edgecolor="black", linewidth=1.0))
    axes.text(x, y, "$m$", ha="center", va="center")


def table(axes: Axes, x: float, y: float, width: float, height: float) -> None:
    """The table, hatched, its upper side at y."""
    axes.add_patch(
        Rectangle(
            (x, y - height),
            width,
            height,
            facecolor="white",
            edgecolor="black",
            hatch="////",
            linewidth=1.0,
        )
    )


def arrow(axes: Axes, x0: float, y0: float, x1: float, y1: float, heads: str = "-|>") -> None:
    """A thin arrow; ``heads`` is one of matplotlib's arrow styles."""
    look = {"arrowstyle": heads, "color": "black", "linewidth": 0.8, "mutation_scale": 8}
    look |= {"shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=(x1, y1), xytext=(x0, y0), arrowprops=look)


def double_arrow(axes: Axes, x: float, y0: float, y1: float) -> None:
    """A vertical double arrow, for the oscillation of the table."""
    arrow(axes, x, y0, x, y1, heads="<|-|>")


def spring(axes: Axes, x: float, y0: float, y1: float, coils: int = 5, width: float = 0.16) -> None:
    """A vertical spring."""
    lead = 0.15 * (y1 - y0)
    zigzag = np.linspace(y0 + lead, y1 - lead, 2 * coils + 1)
    offset = np.where(np.arange(2 * coils + 1) % 2 == 0, -width, width)
    offset[0] = offset[-1] = 0.0
    axes.plot([x, *(x + offset), x], [y0, *zigzag, y1], **LINE)


def damper(axes: Axes, x: float, y0: float, y1: float, width: float = 0.17) -> None:
    """A vertical dashpot."""
    low, high = y0 + 0.3 * (y1 - y0), y0 + 0.68 * (y1 - y0)
    piston = y0 + 0.5 * (y1 - y0)
    axes.plot([x, x], [y0, low], **LINE)
    axes.plot([x - width, x - width, x + width, x + width], [high, low, low, high], **LINE)
    axes.plot([x - 0.75 * width, x + 0.75 * width], [piston, piston], **LINE)
    axes.plot([x, x], [piston, y1], **LINE)

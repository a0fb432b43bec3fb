"""Figure 1: schematic of the restitution-coefficient model."""

from matplotlib.figure import Figure

from bouncing_ball.figures import schematic
from bouncing_ball.figures.style import canvas


def draw() -> Figure:
    """Ball in flight over the table, without contact elements."""
    figure, axes = canvas(2.6, 1.5)
    schematic.blank(axes, (-0.56, 4.42), (0.4, 3.45))
    schematic.ball(axes, 1.7, 2.7, 0.42)
    schematic.table(axes, 0.5, 1.0, 2.4, 0.45)
    axes.text(0.36, 0.78, r"$M=\infty$", ha="right", va="center")
    schematic.arrow(axes, 2.6, 2.7, 2.6, 3.35)
    axes.text(2.72, 3.02, "$y(t)$", ha="left", va="center")
    schematic.double_arrow(axes, 3.1, 0.55, 1.25)
    axes.text(3.25, 0.9, r"$a\,\sin(\Omega t)$", ha="left", va="center")
    schematic.arrow(axes, 0.75, 3.35, 0.75, 2.7)
    axes.text(0.65, 3.02, "$g$", ha="right", va="center")
    axes.plot([1.7, 1.7], [1.0, 2.28], color="#8c8c8c", linewidth=0.7, linestyle=(0, (1, 1.5)))
    axes.text(1.8, 1.2, "impact: $r$", ha="left", va="center", fontsize=8)
    return figure

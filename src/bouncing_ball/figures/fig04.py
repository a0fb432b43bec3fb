"""Figure 4: schematic of the spring-damper model."""

from matplotlib.figure import Figure

from bouncing_ball.figures import schematic
from bouncing_ball.figures.style import canvas


def draw() -> Figure:
    """Ball over a spring and a dashpot that stand on the table."""
    figure, axes = canvas(2.8, 1.5)
    schematic.blank(axes, (-0.58, 4.91), (0.4, 3.5))
    schematic.ball(axes, 1.7, 2.95, 0.42)
    axes.plot([1.15, 2.25], [2.3, 2.3], **schematic.LINE)
    schematic.spring(axes, 1.35, 1.0, 2.3)
    schematic.damper(axes, 2.05, 1.0, 2.3)
    axes.text(1.08, 1.65, "$k$", ha="right", va="center")
    axes.text(2.32, 1.65, "$c$", ha="left", va="center")
    schematic.table(axes, 0.5, 1.0, 2.4, 0.45)
    axes.text(0.36, 0.78, r"$M=\infty$", ha="right", va="center")
    schematic.arrow(axes, 2.6, 2.75, 2.6, 3.4)
    axes.text(2.72, 3.07, "$y(t)$", ha="left", va="center")
    schematic.double_arrow(axes, 3.1, 0.55, 1.25)
    axes.text(3.25, 0.9, r"$a\,\sin(\Omega t+\varphi)$", ha="left", va="center")
    schematic.arrow(axes, 0.75, 3.4, 0.75, 2.75)
    axes.text(0.65, 3.07, "$g$", ha="right", va="center")
    return figure

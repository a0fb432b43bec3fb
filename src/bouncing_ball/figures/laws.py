"""How the contact laws are drawn."""

from bouncing_ball.figures.style import COLOURS, Look

LAWS: dict[str, Look] = {
    "linear": {"color": COLOURS[0], "linestyle": "-"},
    "linear, force release": {"color": COLOURS[0], "linestyle": (0, (1, 1.5))},
    "hunt-crossley": {"color": COLOURS[1], "linestyle": (0, (4, 1.5))},
    "tsuji": {"color": COLOURS[2], "linestyle": (0, (6, 1.5, 1, 1.5))},
    "kuwabara-kono": {"color": COLOURS[3], "linestyle": (0, (2, 1))},
}
"""By name; they differ by their dashes as well as by their colours."""

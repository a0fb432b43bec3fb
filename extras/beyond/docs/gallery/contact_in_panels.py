"""One contact in panels: where they end, and how fast their Legendre coefficients fall."""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.contacts import root_time
from paper_replication import drawing
from paper_replication.drawing import GUIDE, SETTINGS, colours, legend_below

plt.style.use(SETTINGS)

law = bb.simscape_contact(stiffness=700.0, damping=6.0, depth=0.03)
panels = []
next_panel = root_time._next_panel


def recorded(motion, events, side, start, length, newton):
    """Keep each panel with its start and the event at its end."""
    panel, which = next_panel(motion, events, side, start, length, newton)
    panels.append((float(start[2][0]), panel, int(which[0])))
    return panel, which


root_time._next_panel = recorded
impact = law.first_impact(1.0, 2.0, 0.9)[1]
# A panel that was too long is followed by one with the same start.
starts = [start for start, _, _ in panels[1:]] + [np.inf]
accepted = [record for record, after in zip(panels, starts, strict=True) if after > record[0]]

figure, (above, below) = drawing.panels(5.0, rows=2)
shades = colours(len(accepted))
for number, ((_, panel, event), colour) in enumerate(zip(accepted, shades, strict=True), 1):
    q, v, t = (y[:, 0] for y in panel.nodes)
    end = float(panel.end[2][0])
    above.plot(t, q, ".-", color=colour, markersize=4)
    names = ["kink: p = depth", "release: p + κp′ = 0"]
    text = names[event] if event >= 0 else ""
    above.axvline(end, **GUIDE)
    beside = {"textcoords": "offset points", "rotation": 90}
    above.annotate(text, (end, 0.12), (-3, 0), ha="right", va="top", **beside)
    sizes = np.abs(root_time.PANEL.coefficients @ v) / np.abs(v).max()
    below.semilogy(sizes, ".-", color=colour, label=f"panel {number}")
below.axhline(root_time.RESOLVED, **GUIDE)
below.annotate("largest last coefficient", (19.5, 1.5 * root_time.RESOLVED), ha="right")
below.set(xticks=range(0, 20, 4), ylim=(1e-17, 10))
above.set(
    xlabel="time t after the start",
    ylabel="penetration p",
    title="Panels and their nodes",
    ylim=(-0.005, 0.12),
)
below.set(
    xlabel="degree", ylabel="Legendre coefficient of v / max |v|", title="How they are judged"
)
legend_below(figure, columns=3)
figure.savefig("contact_in_panels.png")

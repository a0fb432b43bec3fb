"""Draw the orbits of Fig. 12 in motion: a ball for each contact, on one table.

`motion` draws the first frame, in which the ball of the restitution model hits the table, and
`movement` is the style sheet that moves the parts of the picture. Paper has the first frame, and so
has a browser that is asked for no motion.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon, Rectangle

from carbonelli2011.curves import TABLE, kinds_of, label, title, with_kinds
from carbonelli2011.paper import of_paper
from paper_replication.datasets import parameters
from paper_replication.drawing import POINTS, WIDTH, Look, colours, panels

# Lengths of the picture are in points, from its lower left corner.

TOP = 300.0
LOWEST = 36.0
"""Lowest position of the surface of the table, above the names of the balls."""
ROOM = 200.0
"""Length of all heights together with the deepest penetration."""
RADIUS = 9.0
SOLID = 9.0
"""Length of a contact at the deepest penetration. No model has a length of a contact."""
BLOCK = np.array([(-8, 0), (-8, 1), (8, 1), (8, 0)])
"""Corners of a rigid contact of length 1."""
TURNS = [(6 * (-1) ** k, k / 10) for k in range(1, 10)]
SPRING = np.array([(0, 0), *TURNS, (0, 1), (-8, 1), (8, 1)])
"""Corners of a spring of length 1, with a plate on top."""
RIGID = "#b8b8b8"
"""Grey of the restitution model, as in Fig. 12."""
EDGE = "0.4"
FRAMES = 48
"""Frames of a period of the table, between which all velocities are constant."""
SECONDS = 2.5
"""Duration of a period of the table."""


def frames(data: xr.Dataset) -> xr.Dataset:
    """Return the heights of the table and of the centres of the balls, and the lengths of their
    contacts, for each frame.

    The first ball is that of the restitution model; the others are on contacts that get softer, and
    contacts without an orbit are left out. `time` is a share of the cycle. It begins and ends at
    the impact of the first ball, and has the start and the end of each contact.
    """
    given = of_paper({"fig12": data})["fig12"].sortby("frequency_ratio", ascending=False)
    given["colour"] = "frequency_ratio", list(colours(given.sizes["frequency_ratio"]))
    given = given.dropna("frequency_ratio", how="all", subset=["ball"])
    n = parameters(given)["n"]
    impact = given.restitution_phase.item()
    corners = np.concatenate([given.phase, given.phase + given.contact_duration]) - impact
    steps = np.linspace(0, 1, FRAMES * n + 1)
    # A style sheet has hundredths of a per cent.
    time = np.union1d(steps, corners / (2 * np.pi * n) % 1).round(4)
    phase = impact + 2 * np.pi * n * time
    heights = np.vstack([given.table, given.restitution_ball, given.ball])
    lowest = given.table.values.min()
    depth = np.max(given.table.values - heights)
    unit = ROOM / (np.max(heights) - lowest + depth)
    table, *balls = (
        np.interp(phase, given.table_phase, height, period=2 * np.pi * n) for height in heights
    )
    relaxed = unit * depth + SOLID
    above = unit * (np.array(balls) - lowest) + LOWEST + relaxed + RADIUS
    ratios = given.frequency_ratio.values
    return xr.Dataset(
        {
            "table": ("time", unit * (table - lowest) + LOWEST),
            "centre": (("ball", "time"), above),
            "contact": (("ball", "time"), relaxed + unit * np.minimum(balls - table, 0)),
            "summit": ("ball", heights[1:].max(axis=1)),
        },
        {
            "time": time,
            "name": (
                "ball",
                [
                    with_kinds("rigid", kinds_of(given, "restitution_")),
                    *(
                        with_kinds(label(frequency_ratio=ratio), np.array(kind))
                        for ratio, kind in zip(ratios, kinds_of(given), strict=True)
                    ),
                ],
            ),
            "colour": ("ball", [RIGID, *given.colour.values]),
        },
    )


def motion(data: xr.Dataset) -> Figure:
    """Draw the first frame: balls on their contacts, and above them empty circles at their summits,
    with the distance of the maximum height from that of the restitution model.
    """
    shown = frames(data)
    middle: Look = {"ha": "center", "va": "center"}
    names = [name.replace(" (", "\n(") for name in shown.name.values]
    count = shown.sizes["ball"]
    figure, axes = panels(TOP / POINTS)
    widest = max(figure.text(0, 0, name).get_window_extent().width for name in names)
    figure.texts.clear()
    spacing = max(WIDTH * POINTS / count, widest * POINTS / figure.dpi + 10)
    right = spacing * count
    figure.set_size_inches(right / POINTS, TOP / POINTS)
    figure.set_layout_engine("none")
    axes.set(position=(0, 0, 1, 1), xlim=(0, right), ylim=(0, TOP))
    axes.axis("off")
    axes.text(right / 2, TOP - 10, title(data, "n", "restitution", "amplitude"), **middle)
    surface = shown.table[0].item()
    axes.add_patch(Rectangle((4, surface - 8), right - 8, 8, color=TABLE, gid="table"))
    summits = shown.centre.max("time").values + RADIUS
    axes.axhline(summits[0], color=RIGID, linewidth=2.4)
    higher = 100 * (shown.summit / shown.summit[0] - 1).values
    for k, colour in enumerate(shown.colour.values):
        x = (k + 0.5) * spacing
        look: Look = {"facecolor": "none" if k else "0.85", "closed": k == 0, "edgecolor": EDGE}
        corners = (SPRING if k else BLOCK) * (1, shown.contact[k, 0].item()) + (x, surface)
        axes.add_patch(Polygon(corners, gid=f"contact{k}", **look))
        ball: Look = {"radius": RADIUS, "edgecolor": colour if k else EDGE}
        axes.add_patch(Circle((x, summits[k] - RADIUS), facecolor="none", **ball))
        axes.plot((x - 14, x + 14), (summits[k], summits[k]), color=colour, linewidth=1.6)
        bottom = (x, shown.centre[k, 0].item())
        axes.add_patch(Circle(bottom, facecolor=colour, gid=f"ball{k}", **ball))
        axes.text(x, 12, names[k], **middle)
        axes.text(x, summits[0] + 9, f"${higher[k]:+.1f}$ %" if k else "height", **middle)
    return figure


def movement(data: xr.Dataset) -> str:
    """Return the style sheet that moves the parts of `motion` from their places in the first frame.

    A contact moves with the table, and its length changes about its foot.
    """
    shown = frames(data)
    foot = TOP - shown.table[0].item()
    down = (shown.isel(time=0) - shown).round(1) + 0.0
    scale = (shown.contact / shown.contact[:, 0]).round(3)
    moved = {"table": [f"translate:0 {y:g}px" for y in down.table.values]}
    for k in range(shown.sizes["ball"]):
        moved[f"ball{k}"] = [f"translate:0 {y:g}px" for y in down.centre.values[k]]
        moved[f"contact{k}"] = [f"scale:1 {length:g}" for length in scale.values[k]]
    period = f"{SECONDS * parameters(data)['n']:g}s linear infinite"
    with_table = f"table {period},"
    moving = [
        f"#{name}{{animation:{with_table * name.startswith('contact')}{name} {period}}}"
        for name in moved
    ]
    return "\n".join(
        [
            "[id^=contact] path{vector-effect:non-scaling-stroke}",
            f"[id^=contact]{{transform-origin:0 {foot:.1f}px}}",
            *(keyframes(name, shown.time.values, states) for name, states in moved.items()),
            f"@media screen and (prefers-reduced-motion:no-preference){{{''.join(moving)}}}",
        ]
    )


def keyframes(name: str, time: Sequence[float], states: Sequence[str]) -> str:
    """Return the keyframes of a part over a cycle, without those that are like both neighbours."""
    around = zip(time, ["", *states], states, [*states[1:], ""], strict=False)
    kept = [
        f"{100 * at:.4g}%{{{state}}}"
        for at, before, state, after in around
        if not before == state == after
    ]
    return f"@keyframes {name}{{{''.join(kept)}}}"

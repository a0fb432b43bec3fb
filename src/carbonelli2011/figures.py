"""Draw the figures of the paper and the validity map, each from its dataset.

`draw` draws a figure by its name. Figs. 1 and 4 are schematics without a dataset. The numbers in
titles, legends and labels come from the dataset, or from `paper` if the paper prints them. The
module `drawing` explains line styles, widths and marks.
"""

from collections.abc import Callable, Mapping
from itertools import cycle
from textwrap import fill
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Rectangle
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from carbonelli2011 import paper
from carbonelli2011.curves import (
    KINDS,
    NARROW,
    TABLE,
    WIDE,
    along_ratio,
    branch_legend,
    curve,
    draw_branch,
    kinds_of,
    label,
    look_of,
    mark_look,
    mark_special,
    number_ratios,
    parted,
    restitution_branch,
    right_end,
    spring_damper_branch,
    title,
    with_kinds,
)
from carbonelli2011.motion import motion, movement
from paper_replication.datasets import other_parameters, parameters
from paper_replication.drawing import (
    COLOURS,
    DASHES,
    GUIDE,
    LEGEND_ROWS,
    POINTS,
    WIDTH,
    Look,
    colours,
    latex_number,
    legend_below,
    name_at_right,
    name_points,
    pale,
    panels,
    sample,
    style,
    thin,
)
from paper_replication.texts import share_text

CONTACT = COLOURS[1]
"""Colour of the spring-damper model where it is compared with the restitution model."""

LIMIT: Look = {"color": "black", "linewidth": 1.0, "linestyle": (0, (4.5, 2.25))}
"""Line at the value of the restitution model, the limit of the spring-damper model."""

PRINTED: Look = {"marker": "D", "fillstyle": "none", "linestyle": "none", "color": "black"}
"""Mark of a threshold of ϖ that the paper prints."""

ADVISED: Look = {"color": COLOURS[2], "linewidth": 1.0, "linestyle": DASHES[1]}
"""Line at the ϖ that the paper advises."""

ARROW: Look = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "color": "black"}
PERIOD = 2 * np.pi
"""Period of the table in τ."""

TIME = r"time $\tau/2\pi$"

LABELLED = [1, 2, 5, 10, 100]
"""Frequency ratios that Fig. 13 marks. Larger ones would coincide with the restitution model."""


# Schematics of both models


def fig01() -> Figure:
    """Schematic of the restitution model: ball, table and an instantaneous impact."""
    figure, axes = schematic(r"$a\,\sin(\Omega t)$")
    axes.plot([0, 0], [0.0, 1.75], **GUIDE)
    axes.text(0.12, 0.3, "impact: $r$", va="center")
    return figure


def fig04() -> Figure:
    """Schematic of the spring-damper model: ball, spring, damper and table."""
    figure, axes = schematic(r"$a\,\sin(\Omega t+\varphi)$")
    line: Look = {"color": "black", "linewidth": 1.0}
    zigzag = [0, 0, 0.16, -0.16, 0.16, -0.16, 0.16, -0.16, 0.16, 0, 0]
    axes.plot(np.array(zigzag) - 0.4, [0, 0.2, *np.linspace(0.25, 0.95, 7), 1.0, 1.2], **line)
    # Cylinder, then piston with its rod.
    axes.plot([0.4, 0.4], [0, 0.35], **line)
    axes.plot([0.2, 0.2, 0.6, 0.6], [0.85, 0.35, 0.35, 0.85], **line)
    axes.plot([0.25, 0.55, 0.4, 0.4], [0.6, 0.6, 0.6, 1.2], **line)
    axes.plot([-0.75, 0.75], [1.2, 1.2], **line)
    axes.text(-0.68, 0.6, "$k$", ha="right", va="center")
    axes.text(0.7, 0.6, "$c$", va="center")
    return figure


def schematic(motion: str) -> tuple[Figure, Axes]:
    """Draw the ball above the moving table. The surface of the table is at the height 0."""
    figure, axes = panels(1.9)
    axes.set(xlim=(-2.7, 3.3), ylim=(-0.6, 2.65), aspect="equal")
    axes.axis("off")
    body: Look = {"edgecolor": "black", "linewidth": 1.0}
    axes.add_patch(Circle((0, 2.15), 0.4, facecolor="0.85", **body))
    axes.add_patch(Rectangle((-1.4, -0.5), 2.8, 0.5, facecolor="white", hatch="////", **body))
    axes.annotate("", (-1.1, 1.8), (-1.1, 2.5), arrowprops=ARROW)
    axes.annotate("", (1.1, 2.5), (1.1, 1.8), arrowprops=ARROW)
    axes.annotate("", (1.65, 0.15), (1.65, -0.55), arrowprops=ARROW | {"arrowstyle": "<|-|>"})
    axes.text(0, 2.15, "$m$", ha="center", va="center")
    axes.text(-1.2, 2.15, "$g$", ha="right", va="center")
    axes.text(1.2, 2.15, "$y(t)$", va="center")
    axes.text(1.78, -0.2, motion, va="center")
    axes.text(-1.5, -0.25, r"$M=\infty$", ha="right", va="center")
    return figure, axes


# Restitution model


def fig02(data: xr.Dataset) -> Figure:
    """Heights of ball and table over time for an n-T orbit of the restitution model."""
    figure, axes = panels(2.5)
    time = data.time / PERIOD
    draw_ball(axes, time, data)
    axes.plot(time, data.table, color=TABLE, linewidth=2.0, label="table $w$")
    axes.set(xlabel=TIME, ylabel="height $z$, $w$", xlim=(0, float(time[-1])))
    axes.set_title(title(data, "n", "restitution", "amplitude"))
    legend_below(figure)
    return figure


def draw_ball(axes: Axes, time: xr.DataArray, data: xr.Dataset) -> None:
    """Draw the height of the ball on the orbit of a dataset."""
    kind = str(kinds_of(data))
    look: Look = {"color": "black"} | look_of(kind)
    axes.plot(time, data.ball, label=with_kinds("ball $z$", np.array(kind)), **look)


def fig03(data: xr.Dataset) -> Figure:
    """Branches of n-T orbits of the restitution model over Λ, with their bifurcations.

    The period doublings of Eq. 8 are also marked. The inset enlarges both of the last family.
    """
    figure, axes = panels(3.6)
    amplitude_max = parameters(data)["amplitude_max"]
    names = []
    absent = []
    enlarged: list[tuple[xr.Dataset, xr.Dataset, str]] = []
    for n, colour in zip(data.n.values, colours(data.sizes["n"]), strict=True):
        family = data.sel(n=n)
        branch = restitution_branch(family, family.sel(impact_map="exact"))
        if has_orbits(branch):
            draw_branch(axes, branch, "phase", colour, width=1.2)
            mark_special(axes, branch, "phase", colour)
            doublings = np.sort(family.period_doubling_amplitude)
            if doublings[0] < doublings[-1] <= amplitude_max:
                enlarged = [(branch, family, colour)]
            names.append((label(n=n), right_end(branch, "phase"), colour))
        else:
            absent.append(label(n=n))
    axes.set(xlabel=r"amplitude $\Lambda$", ylabel=r"phase of the impact $\varphi/\pi$")
    axes.set_xlim(0, amplitude_max)
    axes.autoscale_view()
    for chosen in enlarged:
        if not any(
            line.get_path().transformed(axes.transLimits).intersects_bbox(INSET, filled=False)
            for line in axes.lines
        ):
            enlarge_doublings(axes, *chosen)
    axes.set_title(title(data, "restitution") + no_branch(absent))
    branch_legend(figure, both_phases=False)
    figure.draw_without_rendering()
    name_at_right(axes, names)
    return figure


INSET = Bbox.from_bounds(0.74, 0.35, 0.26, 0.3)
"""Room for the enlargement with its numbers, as shares of the panel."""


def enlarge_doublings(axes: Axes, branch: xr.Dataset, family: xr.Dataset, colour: str) -> None:
    """Enlarge the period doublings of the exact map and of Eq. 8, inside the loops of the branches.

    Eq. 8 belongs to the map of Holmes, so the picture of the paper differs here.
    """
    inset = axes.inset_axes((0.75, 0.43, 0.24, 0.22))
    draw_branch(inset, branch, "phase", colour, width=1.2)
    mark_special(inset, branch, "phase", colour)
    amplitudes = family.period_doubling_amplitude
    phases = family.period_doubling_phase / np.pi
    for values, limit in ((amplitudes, inset.set_xlim), (phases, inset.set_ylim)):
        margin = 0.5 * np.ptp(values.values)
        limit(values.min() - margin, values.max() + margin)
    digits = max(3, -int(np.floor(np.log10(np.ptp(amplitudes.values)))))
    texts = [f"{value:.{digits}f}" for value in amplitudes.values]
    inset.set_xticks(amplitudes[:1], texts[:1], size="small")
    inset.set_xticks(amplitudes[1:], texts[1:], size="small", minor=True)
    # Longer numbers are below each other. The other lengths are those of the first tick.
    lower = 9 if len(texts[1]) > len("1.234") else 0
    inset.tick_params(which="minor", length=3.5, width=0.8, pad=3.5 + lower)
    inset.set_yticks([])
    axes.indicate_inset_zoom(inset, edgecolor="0.5")


# Apparent restitution and velocity along ϖ


def fig05(data: xr.Dataset) -> Figure:
    """Apparent restitution against ϖ for each pair (r, Λ), with r as a guide line."""
    figure, axes = panels(3.0)
    draw_cases(axes, data, data.apparent_restitution)
    for restitution in np.unique(data.restitution):
        axes.axhline(restitution, label="restitution model, $r$", **GUIDE)
    axes.set_ylabel("apparent restitution $r_a$")
    legend_below(figure)
    return figure


def fig10(data: xr.Dataset) -> Figure:
    """Bouncing-off velocity against ϖ for each Λ, and its difference from the first Λ."""
    figure, (axes, below) = panels(4.2, rows=2, sharex=True, height_ratios=(3, 2))
    limit = float(data.restitution_bounce_velocity)
    draw_cases(axes, data, data.bounce_velocity)
    axes.axhline(limit, label=r"restitution model, $n\pi$", **GUIDE)
    axes.set_ylabel(r"bouncing-off velocity $z'_b$")
    first = data.isel(case=np.argmax(data.bounce_velocity.notnull().any("frequency_ratio").values))
    draw_cases(below, data, 100 * (data.bounce_velocity - first.bounce_velocity) / limit)
    # The names of the upper panel: where the first case has no orbit, there is no difference.
    for line in below.lines:
        line.set_label("_")
    below.set_title("")
    below.set_ylabel("difference from\n" + rf"{label(amplitude=first.amplitude)}, % of $n\pi$")
    legend_below(figure)
    return figure


def draw_cases(axes: Axes, data: xr.Dataset, values: xr.DataArray) -> None:
    """Draw a curve against ϖ for each case. The title has the parameters that all cases share."""
    common, names = case_names(data)
    shades = colours(data.sizes["case"])
    for k, (name, colour, dashes) in enumerate(zip(names, shades, cycle(DASHES), strict=False)):
        look: Look = {"color": colour, "linestyle": dashes, "label": name}
        kinds = kinds_of(data.isel(case=k))
        curve(axes, data.frequency_ratio.values, values.isel(case=k).values, kinds, **look)
    axes.set_title(common)
    along_ratio(axes, data.frequency_ratio)


def case_names(data: xr.Dataset) -> tuple[str, list[str]]:
    """Return a label of the parameters that all cases share, and a label of each case."""
    n = parameters(data)["n"]
    common, names = parted({"n": [n], "restitution": data.restitution, "amplitude": data.amplitude})
    present = data.phase.notnull().any("frequency_ratio").values
    named = [name or "spring-damper model" for name in names]
    pairs = zip(named, present, strict=True)
    return common, [name if known else f"{name} (no orbit)" for name, known in pairs]


def fig13(data: xr.Dataset) -> Figure:
    """Phase and velocity at both ends of contact for all ϖ, and in the restitution model."""
    figure, axes = panels(4.0)
    common, names = case_names(data)
    shades = colours(data.sizes["case"])
    dot: Look = {"marker": "o", "markersize": 4}
    start = dot | {"markerfacecolor": "white", "linestyle": DASHES[1]}
    end = dot | {"linestyle": "-"}
    star: Look = {"marker": "*", "markersize": 9, "linestyle": "none"}
    limits = np.array([data.restitution_impact_velocity, data.restitution_bounce_velocity])
    labelled = np.argmax(data.phase.notnull().any("frequency_ratio").values)
    labels: list[tuple[float, tuple[float, float], int]] = []
    for k, colour in enumerate(shades):
        case = data.isel(case=k)
        marked = case.interp(frequency_ratio=LABELLED)
        for phase, velocity, look, beyond in (
            ("phase", "impact_velocity", start, 2),
            ("release_phase", "bounce_velocity", end, 3),
        ):
            line = {"color": colour, "linestyle": look["linestyle"]}
            line_points = case[phase].values / np.pi, case[velocity].values / np.pi
            curve(axes, *line_points, kinds_of(case), **line)
            dots = look | line | {"linestyle": "none"}
            axes.plot(marked[phase] / np.pi, marked[velocity] / np.pi, **dots)
            if k == labelled:
                places = zip(marked[phase] / np.pi, marked[velocity] / np.pi, strict=True)
                # In turn above and below the curve, which descends, and the last beyond its end.
                labels += zip(LABELLED, places, (0, 1, 0, 1, beyond), strict=True)
        phases = [float(case.restitution_phase) / np.pi] * 2
        axes.plot(phases, limits / np.pi, color=colour, zorder=4, **star)
    axes.set(xlabel=r"phase of the table over $\pi$", ylabel=r"velocity of the ball $z'/\pi$")
    axes.set_title(common)
    axes.margins(x=0.2, y=0.1)
    entries = {
        r"start of contact, $(\varphi,\,z'_i)$": sample(**start),
        r"end of contact, $(\varphi+\tau_b,\,z'_b)$": sample(**end),
        with_kinds("restitution model", kinds_of(data, "restitution_")): sample(**star),
    }
    exists = data.phase.notnull().values
    # A single case needs no legend of colours.
    if len(names) > 1:
        for name, colour, kinds, known in zip(names, shades, kinds_of(data), exists, strict=True):
            key = with_kinds(name, kinds[known]) if known.any() else name
            entries[key] = sample(color=colour, marker="s", linestyle="none")
    shown = kinds_of(data)[exists]
    others = [kind for kind in KINDS if kind != "stable" and kind in shown]
    entries |= {kind: sample(**look_of(kind)) for kind in others}
    legend_below(figure, entries, columns=1 if len(entries) <= LEGEND_ROWS else 2)
    figure.draw_without_rendering()
    known = [entry for entry in labels if np.isfinite(entry[1]).all()]
    # The ends of the curves come first.
    known.sort(key=lambda entry: entry[0] not in (LABELLED[0], LABELLED[-1]))
    name_points(axes, [(label(frequency_ratio=ratio), *where) for ratio, *where in known])
    return figure


# Permanent contact


def fig11(data: xr.Dataset) -> Figure:
    """Threshold of permanent contact against ϖ, and its minimum."""
    figure, axes = panels(2.9)
    draw_threshold(axes, data)
    legend_below(figure)
    return figure


def fig16(data: xr.Dataset) -> Figure:
    """Thresholds of permanent contact of both models against ϖ, and their relative difference."""
    figure, (axes, below) = panels(4.4, rows=2, sharex=True)
    draw_threshold(axes, data)
    limit = float(data.restitution_threshold)
    axes.axhline(limit, label=r"restitution, $\Lambda_{CR}$", **LIMIT)
    draw_error(below, data, data.threshold_amplitude - limit, "PC")
    if not other_parameters("fig16", data, paper.PARAMETERS["fig16"] | paper.TOLERANCES["fig16"]):
        mark_printed(below, "permanent contact threshold")
    legend_below(figure)
    return figure


def draw_threshold(axes: Axes, data: xr.Dataset) -> None:
    """Draw the threshold Λ_SD, or Λ_F for the force release, and fill the region below it."""
    force = parameters(data)["release"] == "force"
    symbol = r"\Lambda_F" if force else r"\Lambda_{SD}"
    formula = "" if force else r", $2\zeta\sqrt{1-\zeta^2}$"
    ratio = data.frequency_ratio
    threshold = data.threshold_amplitude
    axes.plot(ratio, threshold, color=CONTACT, label=f"spring-damper, ${symbol}$")
    axes.fill_between(ratio, threshold, color="0.9", linewidth=0, label="permanent contact")
    look: Look = {"color": CONTACT, "linewidth": 0.9, "linestyle": DASHES[2]}
    axes.axhline(float(data.minimum_threshold), label=f"minimum{formula}", **look)
    damping = label(damping_ratio=float(data.damping_ratio))
    highest = max(2.0, 1.5 * float(threshold.min()))
    axes.set(title=f"{title(data, 'restitution')}, {damping}", ylim=(0, highest))
    axes.set_ylabel(r"threshold amplitude $\Lambda$")
    along_ratio(axes, ratio)


# Motions over time


def fig07(data: xr.Dataset) -> Figure:
    """One cycle of the spring-damper model, with the instants and velocities of Eqs. 18 to 27."""
    figure, axes = panels(2.9)
    time = data.time / PERIOD
    axes.plot(time, data.table, color=TABLE, linewidth=2.0, label="table $w$")
    draw_ball(axes, time, data)
    end = float(time[-1])
    release = float(data.contact_duration) / PERIOD
    axes.axvspan(0.0, release, color="0.9", linewidth=0, label="contact")
    landing = float(data.ball[0])
    # With the force release, the ball leaves below the level of the table.
    release_height = float(np.interp(release, time, data.ball))
    before = float(data.impact_velocity) * PERIOD
    after = float(data.bounce_velocity) * PERIOD
    for instant, height, velocity, name, side, symbol in (
        (0.0, landing, before, r"$\tau_i=0$", "right", "$z'_i$"),
        (release, release_height, after, r"$\tau_b$", "left", "$z'_b$"),
        (end, landing, before, r"$\tau_2=\tau_i+2\pi n$", "center", "$z'_2$"),
    ):
        axes.axvline(instant, **GUIDE)
        axes.plot(instant, height, "o", color="black", markersize=3.5)
        above: Look = {"xycoords": axes.get_xaxis_transform(), "textcoords": "offset points"}
        # The first two names are beside each other if the contact is short.
        aside = {"right": -2, "center": 0, "left": 2}[side]
        axes.annotate(name, (instant, 1.0), (aside, 3), ha=side, va="bottom", **above)
        draw_velocity(axes, (instant, height), velocity, 0.12 * end, symbol)
    axes.set_title(title(data, "n", "restitution", "amplitude", "frequency_ratio"), pad=16)
    axes.set(xlabel=TIME, ylabel="height $z$, $w$", xlim=(-0.18 * end, 1.12 * end))
    legend_below(figure, columns=3)
    return figure


def draw_velocity(
    axes: Axes, place: tuple[float, float], velocity: float, reach: float, symbol: str
) -> None:
    """Draw the tangent before an impact or after a release. `reach` is its length in time."""
    forward = velocity > 0
    far = place[0] + (reach if forward else -reach), place[1] + reach * abs(velocity)
    tip, tail = (far, place) if forward else (place, far)
    axes.annotate("", tip, tail, arrowprops=ARROW)
    offset, side = ((-5, 1), "right") if forward else ((4, 2), "left")
    axes.annotate(symbol, far, offset, textcoords="offset points", ha=side, va="center")


def fig12(data: xr.Dataset) -> Figure:
    """Heights in both models over time; below, the summit of the stiffest contact, enlarged."""
    figure, (axes, summit) = panels(4.9, rows=2, height_ratios=(3, 2))
    time, table = three_cycles(data, data.table)
    axes.plot(time, table, color=TABLE, linewidth=0.8)
    rigid = kinds_of(data, "restitution_")
    broad: Look = {"color": "0.72", "label": with_kinds("restitution model", rigid)}
    broad |= look_of(str(rigid)) | {"linewidth": 3.4}
    for part in (axes, summit):
        part.plot(*three_cycles(data, data.restitution_ball), **broad)
        draw_contacts(part, data)
    bottom = axes.get_ylim()[0]
    body: Look = {"facecolor": "white", "edgecolor": TABLE, "hatch": "////", "zorder": 0}
    axes.fill_between(time, table, bottom, label="table $w$", **body)
    axes.set(xlabel=TIME, ylabel="height $z$, $w$", xlim=(-0.1, parameters(data)["n"] + 0.35))
    axes.set_ylim(bottom=bottom)
    axes.set_title(title(data, "n", "restitution", "amplitude"))
    show_summit(summit, data)
    summit.set(xlabel=TIME, ylabel="height at the summit")
    legend_below(figure, columns=3)
    return figure


def draw_contacts(axes: Axes, data: xr.Dataset) -> None:
    """Draw the orbit for each ϖ. The line of the stiffest contact is solid and drawn last."""
    stiff_first = data.sortby("frequency_ratio", ascending=False)
    shades = colours(data.sizes["frequency_ratio"])
    for k, (colour, dashes) in enumerate(zip(shades, cycle(DASHES), strict=False)):
        orbit = stiff_first.isel(frequency_ratio=k)
        name = label(frequency_ratio=orbit.frequency_ratio)
        kind = "stable"
        if orbit.ball.isnull().all():
            name += " (no orbit)"
        else:
            kind = str(kinds_of(orbit))
        look: Look = {"color": colour, "linestyle": dashes, "linewidth": 1.0, "zorder": 3 - k / 100}
        look |= look_of(kind) | {"label": with_kinds(name, np.array(kind))}
        axes.plot(*three_cycles(data, orbit.ball), **look)


def three_cycles(data: xr.Dataset, height: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    """Repeat a height over three cycles, the cycle of the dataset in the middle.

    Returns the time in periods and the height. The point between two cycles occurs once, because a
    segment of length zero restarts the dashes.
    """
    time = data.table_phase.values / PERIOD
    cycle_length = parameters(data)["n"]
    times = np.concatenate([time[:-1] - cycle_length, time[:-1], time + cycle_length])
    return times, np.concatenate([height[:-1], height[:-1], height])


def show_summit(axes: Axes, data: xr.Dataset) -> None:
    """Zoom in until the summits of the restitution model and of the stiffest contact differ."""
    place = int(np.argmax(data.restitution_ball.values))
    top = float(data.restitution_ball[place])
    stiffest = float(data.ball.sel(frequency_ratio=data.frequency_ratio.max()).max())
    below = np.fmax(2.5 * (top - stiffest), 0.02 * top)
    # Time in which a free flight falls from the summit to the lower limit.
    reach = np.sqrt(2 * below) / PERIOD
    centre = float(data.table_phase[place]) / PERIOD
    axes.set(xlim=(centre - reach, centre + reach), ylim=(top - below, top + 0.15 * below))


def impact_instant(data: xr.Dataset) -> Figure:
    """The impact that is equivalent to a contact outside of it, and the two terms of its height.

    A column for each contact: motions, force, and terms.
    """
    columns = data.sizes["case"]
    figure, grid = panels(5.0, rows=3, columns=columns, squeeze=False, height_ratios=(5, 3, 3))
    for k, column in enumerate(grid.T):
        draw_instant(column, data.isel(case=k), float(restitution_turn(data)[k]))
    for axes, words in zip(grid[:, 0], ("height $z$, $w$", "force", "difference"), strict=True):
        axes.set_ylabel(words)
    figure.align_ylabels(grid[:, 0])
    grid[1, columns // 2].set_xlabel(r"time $\tau-\varphi_{CR}$")
    legend_below(figure)
    return figure


def restitution_turn(data: xr.Dataset) -> xr.DataArray:
    """Height at which the ball of the restitution model hits the table: Λ sin φ_CR."""
    return data.restitution_max_height - (parameters(data)["n"] * np.pi) ** 2 / 2


def draw_instant(column: NDArray, case: xr.Dataset, rigid: float) -> None:
    """Draw one contact of `impact_instant` in its three panels."""
    motions, force, terms = column
    names = ("frequency_ratio", "restitution", "amplitude")
    motions.set_title("\n".join(label(**{name: case[name].item()}) for name in names))
    terms.set_xticks([])
    if case.summit.isnull():
        middle: Look = {"ha": "center", "va": "center"}
        for axes in column:
            axes.set(xticks=[], yticks=[])
            axes.text(0.5, 0.5, "no orbit", transform=axes.transAxes, **middle)
        return
    motions.plot(case.time, case.table, color=TABLE, linewidth=2.0, label="table $w$")
    motions.plot(case.time, case.ball, color="black", label="ball $z$")
    dashed: Look = {"color": CONTACT, "linestyle": DASHES[1], "label": "equivalent impact"}
    motions.plot(case.time, case.instant_ball, **dashed)
    motions.plot(case.centroid, case.instant_ball.min(), "o", color=CONTACT, markersize=4)
    star: Look = {"marker": "*", "markersize": 8, "linestyle": "none", "color": COLOURS[2]}
    motions.plot(0, rigid, label="impact, restitution model", zorder=4, **star)
    motions.tick_params(labelbottom=False)
    force.fill_between(case.time, case.force, color="0.8", linewidth=0, label="contact force")
    force.axvline(case.centroid, color=CONTACT, linewidth=1.0, label="its centroid")
    force.sharex(motions)
    force.set_xticks([0, first_digit(case.time.max().item())])
    force.xaxis.set_major_formatter("{x:g}")
    parts = {
        "depth of the impact": (case.depth, CONTACT),
        "rise of the table": (case.table_rise, TABLE),
        "sum": (case.depth + case.table_rise, "black"),
    }
    for k, (name, (value, colour)) in enumerate(parts.items()):
        terms.bar(k, value, color=colour, label=name)
    terms.axhline(0, color="black", linewidth=0.6)
    higher = 100 * (case.summit / case.restitution_max_height - 1).item()
    kind = "stable" if case.stable else "unstable"
    kind = kind if case.admissible else "inadmissible"
    below = "" if kind == "stable" else f"\n({kind})"
    terms.set_title(f"height\n${higher:+.1f}$ %{below}")
    for axes in column:
        axes.yaxis.set_major_locator(MaxNLocator(3))


def first_digit(value: float) -> float:
    """Round a positive number down to its first digit.

    Examples
    --------
    >>> first_digit(0.187), first_digit(2.9)
    (0.1, 2.0)
    """
    unit = 10 ** np.floor(np.log10(value))
    return float(np.floor(value / unit) * unit)


# Branches of the spring-damper model


Branch = tuple[str, xr.Dataset, str]
"""Name, dataset and colour of a branch of orbits."""


def fig08(data: xr.Dataset) -> Figure:
    """Branches over Λ, a panel for each ϖ: phases of the table at the start and end of contact."""
    contacts = contact_branches(data)
    # At most the height of a page.
    height = np.clip(2.5 * len(contacts), 3.2, 9.5)
    return domains(data, [[branch] for branch in contacts], height)


def fig09(data: xr.Dataset) -> Figure:
    """Branches over Λ for several ϖ: phases of the table at the start and end of contact."""
    return domains(data, [contact_branches(data)], height=4.8)


def fig15(data: xr.Dataset) -> Figure:
    """Branches of both models over Λ: phases of the table at the start and end of contact."""
    names = ("amplitude", "phase", "stable", "admissible")
    rigid = xr.Dataset({name: data[f"restitution_{name}"] for name in names})
    shown = [("restitution", restitution_branch(rigid, data), COLOURS[0])]
    contact = spring_damper_branch(data.squeeze("frequency_ratio"))
    shown.append((label(frequency_ratio=contact.frequency_ratio), contact, CONTACT))
    return domains(data, [shown], height=4.2)


def contact_branches(data: xr.Dataset) -> list[Branch]:
    """Return the branch of the spring-damper model for each ϖ."""
    shades = colours(data.sizes["frequency_ratio"])
    shown = []
    for ratio, colour in zip(data.frequency_ratio, shades, strict=True):
        branch = spring_damper_branch(data.sel(frequency_ratio=ratio))
        shown.append((label(frequency_ratio=ratio), branch, colour))
    return shown


def domains(data: xr.Dataset, shown: list[list[Branch]], height: float) -> Figure:
    """Draw both phases of branches over Λ in a column of panels at one scale of the phase.

    `shown` lists the branches of each panel. The title names branches without orbits.
    """
    absent = [name for panel in shown for name, branch, _ in panel if not has_orbits(branch)]
    present = [[pair for pair in panel if has_orbits(pair[1])] for panel in shown]
    present = [panel for panel in present if panel]
    figure, grid = panels(height, rows=len(present), sharex=True, squeeze=False)
    column = grid[:, 0]
    for axes, panel in zip(column, present, strict=True):
        draw_phases(axes, panel)
    spans = np.array([np.ptp(axes.get_ylim()) for axes in column])
    # A branch with a short range of phases still needs room for its numbers and its name.
    column[0].get_gridspec().set_height_ratios(np.maximum(spans, 0.25 * spans.max()))
    amplitude_max = parameters(data)["amplitude_max"]
    least = min(float(branch.amplitude.min()) for panel in present for _, branch, _ in panel)
    # If all branches start far to the right, the space left of them would be empty.
    left = 0.0 if least < amplitude_max / 2 else 1.1 * least - 0.1 * amplitude_max
    column[0].set_xlim(left, amplitude_max)
    column[0].set_title(title(data, "n", "restitution") + no_branch(absent))
    column[-1].set_xlabel(r"amplitude $\Lambda$")
    column[len(column) // 2].set_ylabel(r"phase of the table over $\pi$")
    branch_legend(figure, both_phases=True)
    figure.draw_without_rendering()
    for axes, panel in zip(column, present, strict=True):
        name_at_right(axes, branch_names(panel, 0.01 * np.ptp(axes.get_ylim())))
    return figure


def no_branch(absent: list[str]) -> str:
    """Return the lines of a title that name branches without orbits."""
    lines = [", ".join(absent[k : k + 3]) for k in range(0, len(absent), 3)]
    return "\nno branch for " + ",\n".join(lines) if absent else ""


def has_orbits(branch: xr.Dataset) -> bool:
    """Whether a branch has at least one orbit."""
    return bool(branch.amplitude.notnull().any())


def draw_phases(axes: Axes, panel: list[Branch]) -> None:
    """Draw both phases of branches, with their special points."""
    for _, branch, colour in panel:
        draw_branch(axes, branch, "phase", pale(colour), WIDE)
        draw_branch(axes, branch, "release_phase", colour, NARROW)
        for phase in ("phase", "release_phase"):
            mark_special(axes, branch, phase, colour)


def branch_names(present: list[Branch], close: float) -> list[tuple[str, float, str]]:
    """Return labels for the right ends of both phases of branches, or one label if they are close.

    Each label is a text, a height in data coordinates and a colour.
    """
    names = []
    for name, branch, colour in present:
        start = right_end(branch, "phase")
        end = right_end(branch, "release_phase")
        heights = [end] if abs(end - start) < close else [start, end]
        names += [(name, height, colour) for height in heights]
    return names


# Errors


def fig14(data: xr.Dataset) -> Figure:
    """Maximum height in both models against ϖ, and the relative error of the restitution model."""
    figure, (axes, below) = panels(4.2, rows=2, sharex=True)
    look: Look = {"color": CONTACT, "label": "spring-damper model"}
    curve(axes, data.frequency_ratio.values, data.max_height.values, kinds_of(data), **look)
    limit = float(data.restitution_max_height)
    axes.axhline(limit, label="restitution model", **LIMIT)
    axes.set_ylabel(r"maximum height $\max\,z$")
    axes.set_title(title(data, "n", "restitution", "amplitude"))
    along_ratio(axes, data.frequency_ratio)
    draw_error(below, data, data.max_height - limit, "h")
    if not other_parameters("fig14", data, paper.PARAMETERS["fig14"] | paper.TOLERANCES["fig14"]):
        mark_printed(below, "height threshold")
        for part in (axes, below):
            part.axvline(paper.STIFF, label=f"advised: {paper.STIFF:g}", **ADVISED)
    legend_below(figure)
    return figure


def draw_error(axes: Axes, data: xr.Dataset, difference: xr.DataArray, name: str) -> None:
    """Draw the relative error of the restitution model, its tolerance, and any threshold of ϖ.

    The error is zero where the difference of the models changes sign. There its line reaches the
    lower edge of the logarithmic panel.
    """
    tolerance = parameters(data)["tolerance"]
    percent = f"{100 * tolerance:g}"
    ratio = data.frequency_ratio.values
    error = data.relative_error.values
    sign = np.sign(difference.values)
    zeros = np.flatnonzero(sign[1:] * sign[:-1] < 0) + 1
    between = np.sqrt(ratio[zeros - 1] * ratio[zeros])
    bottom = 0.5 * np.min(error[error > 0], initial=tolerance)
    # The thresholds of permanent contact (Fig. 16) are no orbits.
    kinds = kinds_of(data) if "phase" in data else np.full(ratio.size, "stable")
    shown = np.insert(ratio, zeros, between), np.insert(error, zeros, bottom)
    curve(axes, *shown, np.insert(kinds, zeros, kinds[zeros]), color=CONTACT)
    axes.axhline(tolerance, label=f"tolerance {percent} %", **GUIDE)
    threshold = float(data.error_threshold)
    if np.isfinite(threshold):
        axes.axvline(threshold, **GUIDE)
        value = rf"$\varpi_{{{name},{percent}\%}}={latex_number(threshold)}$"
        after = np.searchsorted(ratio, threshold)
        value = with_kinds(value, kinds[max(after - 1, 0) : after + 1])
        axes.plot(threshold, tolerance, "o", color="black", markersize=4, label=value)
    axes.set(yscale="log", ylabel="relative error")
    axes.set_ylim(bottom=bottom)
    along_ratio(axes, data.frequency_ratio)


def mark_printed(axes: Axes, claim: str) -> None:
    """Mark the printed threshold of ϖ at the error that the paper allows."""
    printed = paper.PRINTED[claim]
    axes.plot(float(printed), paper.LIMIT, label=f"printed: {printed}", **PRINTED)


# Where the frequency ratio of the paper is enough

DOUBLED: Look = {"facecolor": pale(COLOURS[2]), "edgecolor": COLOURS[2], "linewidth": 0.8}


def validity_map(data: xr.Dataset) -> Figure:
    """Orbits for which the advised ϖ is not enough, with a panel for each quantity and each n.

    The vertical axis is stretched at both ends, where the orbits that fail are.
    """
    given = parameters(data)
    shape: Look = {"rows": data.sizes["quantity"], "columns": data.sizes["n"], "squeeze": False}
    # Further columns make the picture wider.
    width = WIDTH + 0.8 * max(0, data.sizes["n"] - 3)
    figure, grid = panels(5.6, **shape, width=width, sharex=True, sharey=True)
    for row, quantity in zip(grid, data.quantity.values, strict=True):
        for axes, n in zip(row, data.n.values, strict=True):
            draw_failures(axes, data.sel(quantity=quantity, n=n), given["tolerance"])
        row[0].set_ylabel(fill(paper.QUANTITIES[quantity], 14))
    for axes, n in zip(grid[0], data.n.values, strict=True):
        axes.set(xlim=data.restitution[[0, -1]], ylim=(0, 1))
        axes.set_title(label(n=n), pad=14)
        axes.set_yscale("function", functions=(stretched, compressed))
        axes.set_yticks([0, 0.01, 0.1, 0.5, 0.9, 0.99, 1], ["0 %", 1, 10, 50, 90, 99, 100])
        axes.xaxis.set_major_locator(MaxNLocator(3))
    for axes in grid[-1]:
        axes.set_xlabel("restitution $r$")
    # Above the legend, the middle of the panels is higher than that of the figure.
    figure.supylabel(
        "$\\Lambda$ from saddle-node (0 %) to period doubling (100 %)\nof the restitution model",
        y=0.56,
        multialignment="center",
    )
    advised = rf"$\varpi={latex_number(given['advised'])}$"
    space = " " if given["advised"] < 1e4 else "\n"
    entries = {
        f"{advised} is not enough:{space}on the share above the panel": Patch(facecolor=CONTACT),
        f"the contact of {advised} has doubled the period": Patch(**DOUBLED),
    }
    legend_below(figure, entries, columns=1)
    figure.draw_without_rendering()
    # A second layout would move the panels a little.
    figure.set_layout_engine("none")
    thin(grid[-1, 0].xaxis)
    return figure


def regimes(data: xr.Dataset) -> Figure:
    """What a ball does over Λ, and at which ϖ the restitution model has the quantity.

    The upper panel is about the restitution model, in which no ϖ occurs.
    """
    given = parameters(data)
    percent = f"{100 * given['tolerance']:g} %"
    ratio = data.frequency_ratio
    first, last = data.amplitude.values[[0, -1]]
    rest = float(data.restitution_threshold)
    figure, (line, axes) = panels(4.5, rows=2, sharex=True, height_ratios=(1, 5))
    bars = (
        (0, rest, "a ball at rest stays at rest"),
        (first, last, f"stable {given['n']}-T orbit"),
    )
    for height, (start, end, _) in enumerate(bars):
        line.barh(height, end - start, left=start, height=0.7, color="0.85")
    for kind, end in (("saddle-node", first), ("period doubling", last)):
        line.plot(end, 1, color="black", label=kind, **mark_look(kind))
    figure.suptitle(f"{paper.QUANTITIES[given['quantity']]}, {title(data, 'n', 'restitution')}")
    line.set_title("restitution model", loc="left")
    axes.set_title("spring-damper model", loc="left")
    axes.set_xlim(0, 1.1 * max(last, rest))
    line.axis("off")

    right: Look = {"facecolor": "#dcebf5", "linewidth": 0, "label": f"within {percent}"}
    enough = data.enough_from.fillna(ratio.max())
    axes.fill_between(data.amplitude, enough, ratio.max(), **right)
    wrong: Look = {"facecolor": CONTACT, "linewidth": 0, "label": f"off by more than {percent}"}
    axes.fill_between(data.amplitude, ratio.min(), enough, **wrong)
    doubling = data.period_doubling_amplitude.clip(first, last)
    axes.fill_betweenx(ratio, doubling, last, label="period doubled", **DOUBLED)
    alone: Look = {"facecolor": "0.75", "linewidth": 0, "label": "orbit in this model only"}
    axes.fill_betweenx(ratio, data.saddle_node_amplitude.clip(max=first), first, **alone)
    axes.plot(data.threshold_amplitude, ratio, color="black", label="limit of rest")
    axes.axhline(
        given["advised"],
        label=rf"$\varpi={latex_number(given['advised'])}$",
        **ADVISED | {"color": "black"},
    )
    axes.set(xlabel=r"amplitude $\Lambda$", yscale="log", ylim=ratio[[0, -1]])
    axes.set_ylabel(r"frequency ratio $\varpi$ of the contact")
    number_ratios(axes.yaxis, ratio)
    legend_below(figure)
    figure.draw_without_rendering()
    for height, (start, end, words) in enumerate(bars):
        name_bar(line, height, start, end, words)
    return figure


def name_bar(axes: Axes, height: float, start: float, end: float, words: str) -> None:
    """Write words into a bar, or beside it where there is more room."""
    text = axes.text((start + end) / 2, height, words, ha="center", va="center")
    left, right = axes.transData.transform([(start, height), (end, height)])[:, 0]
    # The marks at the ends need room, too.
    if text.get_window_extent().width + 12 / POINTS * axes.figure.dpi > right - left:
        low, high = axes.get_xlim()
        beside = (start, (-5, 0), "right") if start - low > high - end else (end, (5, 0), "left")
        text.remove()
        where: Look = {"textcoords": "offset points", "ha": beside[2], "va": "center"}
        axes.annotate(words, (beside[0], height), beside[1], **where)


def stretched(position: NDArray) -> NDArray:
    """Stretch both ends of the range from 0 to 1: the ratio to 1 - position becomes its cube root.

    Examples
    --------
    >>> stretched(np.array([0.0, 0.002, 0.5, 1.0])).round(3).tolist()
    [0.0, 0.112, 0.5, 1.0]
    """
    below = np.cbrt(position)
    above = np.cbrt(1 - position)
    return below / (below + above)


def compressed(height: NDArray) -> NDArray:
    """Invert `stretched`."""
    return height**3 / (height**3 + (1 - height) ** 3)


def draw_failures(axes: Axes, data: xr.Dataset, tolerance: float) -> None:
    """Draw the failing orbits of one quantity and one n, and their share as a number.

    The orbits that are unstable on the contact cover them.
    """
    excess = (data.stiff_error - tolerance).transpose("place", "restitution")
    over = data.restitution, data.place, excess
    if (excess > 0).any():
        axes.contourf(*over, levels=[0, float(excess.max()) + 1], colors=CONTACT)
        # The border keeps thin regions visible.
        axes.contour(*over, levels=[0], colors=CONTACT, linewidths=0.8)
    if (data.doubled_share > 0).any():
        axes.fill_between(data.restitution, 1 - data.doubled_share, 1, zorder=2, **DOUBLED)
    share: Look = {"color": CONTACT, "ha": "center", "transform": axes.transAxes}
    axes.text(0.5, 1.04, share_text(float(data.failing_mean)), **share)
    axes.spines[["top", "right"]].set_visible(True)


class Empty(ValueError):
    """A picture would have no curve."""


SCHEMATICS: Mapping[str, Callable[[], Figure]] = {"fig01": fig01, "fig04": fig04}
"""Figures of the models, which need no dataset."""
PLOTS: Mapping[str, Callable[[xr.Dataset], Figure]] = {
    "fig02": fig02,
    "fig03": fig03,
    "fig05": fig05,
    "fig06": fig05,
    "fig07": fig07,
    "fig08": fig08,
    "fig09": fig09,
    "fig10": fig10,
    "fig11": fig11,
    "fig12": fig12,
    "fig13": fig13,
    "fig14": fig14,
    "fig15": fig15,
    "fig16": fig16,
    "impact_instant": impact_instant,
    "motion": motion,
    "validity_map": validity_map,
    "regimes": regimes,
}
FIGURES: Mapping[str, Callable[..., Figure]] = {**SCHEMATICS, **PLOTS}


def draw(name: str, *data: xr.Dataset, own: Mapping[str, Any] | None = None) -> Figure:
    """Draw a figure of the paper, fig01 to fig16, or the validity map from its dataset.

    fig01 and fig04 need no dataset. Of matplotlib's settings only those of `own` count, as in
    `drawing.style`, which says what it raises. Raises Empty if the dataset has no orbit.
    """
    for dataset in data:
        orbits = dataset.get("phase", dataset.get("ball"))
        if orbits is not None and orbits.isnull().all():
            raise Empty(f"{name} would be empty: {empty_because(dataset)}")
    with style(own):
        return FIGURES[name](*data)


def moving(name: str, *data: xr.Dataset) -> str:
    """Return the style sheet that moves a figure in its SVG, or an empty one."""
    return movement(*data) if name == "motion" else ""


def empty_because(data: xr.Dataset) -> str:
    """Say of which parameters there is no orbit, and which amplitudes have one."""
    given = parameters(data)
    names = ("n", "restitution", "amplitude", "cases", "frequency_ratio", "amplitude_max")
    asked = ", ".join(f"{name} = {given[name]}" for name in names if name in given)
    return (
        f"no orbit has {asked}; orbits exist above the amplitude nπ(1 - r)/(1 + r) (Eq. 7), and on "
        "a stiff contact they are stable up to that of Eq. R1"
    )

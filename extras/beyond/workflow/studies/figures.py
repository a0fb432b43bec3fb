"""The figures, each a function of its dataset, in the style of those of the replication."""

from collections.abc import Callable, Iterator, Mapping
from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.path import Path

from bouncing_ball.datasets import parameters
from bouncing_ball.drawing import (
    COLOURS,
    DASHES,
    GUIDE,
    TABLE,
    WHOLE_WIDTH,
    Look,
    along_ratio,
    label,
    legend_below,
    name_at_right,
    panels,
    sample,
    style,
    title,
)
from studies.variables import LAW_NAMES

TITLES: Mapping[str, str] = {
    "max_height": r"greatest height $\max\,z$",
    "bounce_velocity": r"bouncing-off velocity $z'_b$",
    "phase": r"phase of touch $\varphi$",
    "apparent_restitution": "apparent restitution $r_a$",
    "saddle_node": r"saddle-node $\Lambda_{SN}$",
    "period_doubling": r"period doubling $\Lambda_{PD}$",
}
"""The quantities whose errors are shown, as titles of panels."""

CONTACT = COLOURS[1]
MODELS: Mapping[str, Look] = {
    "restitution": {"color": COLOURS[0], "linewidth": 1.0},
    "corrected": {"color": COLOURS[3], "linestyle": (0, (4, 1.5))},
}
"""The lines of both models of impacts as instants."""


# One contact

RELEASES: Mapping[str, Look] = {
    "displacement": {"color": COLOURS[0]},
    "force": {"color": COLOURS[1], "linestyle": DASHES[1], "linewidth": 1.6},
}


def ext_impact(data: xr.Dataset) -> Figure:
    """The force in one contact with both ends; restitution coefficient and duration over ζ."""
    figure, (force, restitution, duration) = panels(2.5, columns=3)
    load = data.free_force
    pulls = load.where(load <= 0)
    body: Look = {"facecolor": "0.9", "edgecolor": TABLE, "hatch": "////", "linewidth": 0}
    force.axhline(0, **GUIDE)
    force.plot(data.time, load, color=COLOURS[0])
    force.fill_between(data.time, pulls, **body)
    # The displacement release is at the end of the curve, and the force release at its zero.
    heights = {"displacement": float(load[-1]), "force": 0.0}
    places: dict[str, Look] = {
        "displacement": {"xytext": (4, -6), "ha": "right", "va": "top"},
        "force": {"xytext": (2, 6), "ha": "left", "va": "bottom"},
    }
    for release, look in RELEASES.items():
        one = data.sel(release=release)
        restitution.plot(data.damping_ratio, one.restitution, **look)
        duration.plot(data.damping_ratio, one.contact_duration / np.pi, **look)
        end = float(one.contact_end), heights[release]
        force.plot(*end, "o", color=look["color"], markersize=4, zorder=5)
        text = f"$\\omega D={end[0]:.2f}$\n$r={float(one.end_restitution):.2f}$"
        note: Look = places[release] | {"textcoords": "offset points", "color": look["color"]}
        force.annotate(text, end, **note)
    force.set(xlabel=r"time $\omega t$,  $\omega = \sqrt{k/m}$", ylabel=r"force $/\,(m\omega v)$")
    force.set_xticks(np.pi * np.arange(3) / 2, ["0", r"$\pi/2$", r"$\pi$"])
    force.set_title("one contact")
    force.margins(y=0.3)
    damping = r"damping ratio $\zeta = c\,/\,(2\sqrt{km})$"
    restitution.set(xlabel=damping, ylabel="$r$", title="restitution coefficient", ylim=(0, 1.05))
    duration.set(xlabel=damping, ylabel=r"$\omega D/\pi$", title="duration $D$", ylim=(0, 1.3))
    # Above the upper and below the lower line.
    middle = data.isel(damping_ratio=2 * data.sizes["damping_ratio"] // 5)
    sides: dict[str, Look] = {
        "displacement": {"xytext": (0, 16), "ha": "center", "va": "bottom"},
        "force": {"xytext": (0, -8), "ha": "center", "va": "top"},
    }
    for release, side in sides.items():
        place = float(middle.damping_ratio), float(middle.contact_duration.sel(release=release))
        name: Look = side | {"textcoords": "offset points", "color": RELEASES[release]["color"]}
        duration.annotate(f"{release} release", (place[0], place[1] / np.pi), **name)
    left: Look = {"xytext": (-4, 0), "textcoords": "offset points", "ha": "right", "va": "center"}
    starts = float(data.contact_end.sel(release="force"))
    force.annotate("the table pulls", (starts, heights["displacement"] / 2), **left)
    return figure


def ext_instant(data: xr.Dataset) -> Figure:
    """The flights before and after a contact, continued until they meet; below, its force."""
    figure, (top, below) = panels(3.5, rows=2, sharex=True, height_ratios=(2.2, 1.0))
    time = data.time.values
    end = float(data.contact_duration)
    touching = (time >= 0) & (time <= end)
    near = (time > -0.15 * end) & (time < 1.15 * end)
    continued = {"before": time >= 0, "after": time <= end}
    for (name, part), colour in zip(continued.items(), COLOURS[2:4], strict=True):
        flight = data[f"flight_{name}"].where(part & near)
        look: Look = {"color": colour, "linestyle": DASHES[1], "linewidth": 1.1}
        top.plot(time, flight, label=f"flight {name}, continued", **look)
    top.plot(time, data.table, color=TABLE, linewidth=2.0, label="table, $w$")
    top.plot(time, data.ball, color=CONTACT, label=r"ball, $w+\delta$")
    top.plot(time[touching], data.ball[touching], color=CONTACT, linewidth=2.4)
    meeting = float(data.meeting_time)
    low = float(data.meeting_height)
    top.plot(meeting, low, "o", color="black", markersize=4, zorder=5)
    force = data.contact_force[touching]
    below.fill_between(time[touching], force, facecolor="#bfdbec", edgecolor=CONTACT)
    for axes in (top, below):
        axes.axvline(meeting, **GUIDE)
    below.annotate("$t^*$", (meeting, 0), (3, 3), textcoords="offset points")
    # The delay t_c, below the instant, and its depth v t_c under the level of the table there.
    arrow: Look = {
        "arrowstyle": "<->",
        "color": "0.3",
        "shrinkA": 0,
        "shrinkB": 0,
        "linewidth": 0.8,
    }
    level = float(np.interp(meeting, time, data.table))
    depth = float(data.table[touching].max()) - low
    under = low - 0.12 * depth
    top.annotate("", (0, under), (meeting, under), arrowprops=arrow)
    top.annotate("$t_c$", (meeting / 2, under), (0, 3), textcoords="offset points", ha="center")
    top.annotate("", (meeting, low), (meeting, level), arrowprops=arrow)
    middle = low + 0.75 * (level - low)
    top.annotate(r"$v\,t_c$", (meeting, middle), (5, 0), textcoords="offset points", va="center")
    top.axvline(0, **GUIDE)
    top.set(ylabel=r"height, in units of $g/\Omega^2$")
    top.set_ylim(low - 0.25 * depth, low + 1.6 * depth)
    top.set_title(title(data, "n", "restitution", "amplitude", "frequency_ratio"))
    top.margins(x=0)
    below.set(xlabel=r"time since the touch, $\tau-\varphi$", ylabel="force / weight")
    legend_below(figure)
    return figure


# Errors of both models

QUANTILES = (0.05, 0.5, 0.95)
"""The median of measured orders, and the ends of their middle 90 %."""

LAW: Look = {"color": COLOURS[4], "linewidth": 1.2, "linestyle": DASHES[2]}
"""What the error law leaves."""


def with_zero(x: np.ndarray, size: np.ndarray, zero: float) -> tuple[np.ndarray, np.ndarray]:
    """The size of an error along x, with more and more samples towards its zero, if it has one.

    There it is linear in ln x.

    Examples
    --------
    >>> x, size = with_zero(np.array([1.0, 100.0]), np.array([2.0, 2.0]), 10.0)
    >>> round(float(x[size.argmin()]), 6), bool(size.min() < 1e-10)
    (10.0, True)
    """
    if not np.isfinite(zero):
        return x, size
    after = int(np.searchsorted(x, zero))
    shares = np.geomspace(0.5, 1e-12, 40)
    left = zero * (x[after - 1] / zero) ** shares
    right = zero * (x[after] / zero) ** shares[::-1]
    sizes = [size[:after], size[after - 1] * shares, size[after] * shares[::-1], size[after:]]
    return np.concatenate([x[:after], left, right, x[after:]]), np.concatenate(sizes)


def ext_orders(data: xr.Dataset) -> Figure:
    """Errors of both models and what the error law leaves, along ϖ, with their orders in 1/ϖ.

    The last panel has those of the height at the saddle-node of the restitution model.
    """
    figure, slots = panels(3.9, rows=2, columns=4, sharex=True, sharey=True)
    first, second, third, beside, *others, at_node = slots.flat
    panels_of = first, second, third, *others
    ratio = data.frequency_ratio
    orbit = data.sel(place="orbit")
    zeros = {"restitution": data.error_zero, "corrected": data.corrected_error_zero}
    for quantity, axes in zip(data["quantity"].values.tolist(), panels_of, strict=True):
        part = orbit.sel(quantity=quantity)
        orders = []
        for order, (model, look) in enumerate(MODELS.items(), 1):
            error = part.relative_error.sel(model=model).values
            zero = float(zeros[model].sel(quantity=quantity))
            axes.plot(*with_zero(ratio.values, error, zero), label=f"{model} model", **look)
            draw_slope(axes, ratio, error, order)
            orders.append((part.order.sel(model=model), look))
        axes.plot(ratio, part.law_left, label="left by the\nerror law", **LAW)
        note_orders(axes, [*orders, (part.law_order, LAW)])
        axes.set_title(TITLES[quantity])
    node = data.sel(place="saddle-node", quantity="max_height")
    rigid = MODELS["restitution"]
    for left, slope, look in ((node.node_error, 0.5, rigid), (node.law_left, 1.5, LAW)):
        at_node.plot(ratio, left, **look)
        draw_slope(at_node, ratio, left.values, slope)
    note_orders(at_node, [(node.node_order, rigid), (node.law_order, LAW)])
    at_node.set_title(r"height at $\Lambda=C$")
    for axes in (*panels_of, at_node):
        axes.set(yscale="log", ylabel="relative error")
        along_ratio(axes, ratio)
        axes.set_xticks([1, 100, 10000])
        # Errors are below 1 but next to a phase of 0; the orders have the room above.
        axes.set_ylim(1e-10, 1e4)
    beside.set_axis_off()
    figure.suptitle(title(data, "n", "restitution", "amplitude"), fontsize="medium")
    lines, names = first.get_legend_handles_labels()
    slopes = sample(**GUIDE)
    beside.legend([*lines, slopes], [*names, "slopes of the\norders expected"], loc="center")
    return figure


def draw_slope(axes: Axes, ratio: xr.DataArray, error: np.ndarray, order: float) -> None:
    """A guide with the slope of an order in 1/ϖ, beside the last point of an error."""
    ends = ratio.values[[0, -1]]
    axes.plot(ends, 3 * error[-1] * (ends[-1] / ends) ** order, **GUIDE)


def note_orders(axes: Axes, orders: list[tuple[xr.DataArray, Look]]) -> None:
    """Medians of measured orders and their middle 90 %, each beside a sample of its line."""
    texts = []
    for order, _ in orders:
        low, middle, high = order.quantile(QUANTILES).values
        texts.append(f"{middle:.2f} ({low:.2f} to {high:.2f})")
    lines = [sample(**look) for _, look in orders]
    place: Look = {"loc": "upper right", "fontsize": 6.5, "borderaxespad": 0, "labelspacing": 0.2}
    axes.legend(lines, texts, handlelength=2.2, **place)


# Map

POSITIONS = (0, 0.01, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.95, 0.99, 1)
"""Positions of Λ in the stable range that are named; p = sin² of the places on the axis."""

BELOW = (0, 0.001, 0.005, 0.02, 0.05, 0.1)
"""Distances from the saddle-node that are named; the axis is even in their square roots."""

LEVELS = (15, 20, 30, 40, 50, 60, 70, 80, 90)
"""Contours of the ϖ from which on the height is right, where it leaves the tolerance downwards."""

EXACT: Look = {"color": "black", "linewidth": 0.8}
BY_LAW: Look = {"color": COLOURS[4], "linewidth": 2.6}
JUMP: Look = {"color": "black", "linewidth": 1.1, "linestyle": (0, (1, 1.5))}
ON_LINE: Look = {
    "ha": "center",
    "va": "center",
    "fontsize": 6.5,
    "clip_on": True,
    "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.5},
}
TOO_HIGH = {200.0: 0.2, 1000.0: 0.13}
"""The r at which lines of too large heights are named, which are near to each other."""

ROOM = 0.012
"""The least place of a line with a name, half the height of the name."""

NOT_ENOUGH: Mapping[str, Look] = {
    "rule of thumb": {"facecolor": "0.86"},
    "paper": {"facecolor": "0.86", "hatch": "/////", "edgecolor": "0.6"},
}
"""Where the ϖ of each judge is not enough."""


def places(position: xr.DataArray) -> xr.DataArray:
    """Places on the axis of positions, arcsin √p, negative below the saddle-node."""

    def place(p: np.ndarray) -> np.ndarray:
        return np.sign(p) * np.arcsin(np.sqrt(np.minimum(np.abs(p), 1)))

    return xr.apply_ufunc(place, position)


def ext_map(data: xr.Dataset) -> Figure:
    """From which ϖ on a contact is stable, as high, and bounces where the restitution model does.

    The rows are in the order of Λ: from the period doubling down to the saddle-node, for the
    stability and for the height, and below the saddle-node. Narrow lines are exact, wide ones those
    of the error law. The ϖ of the rule of thumb and of the paper are not enough in shaded places.
    """
    columns = data.sizes["n"]
    options: Look = {"sharex": True, "sharey": "row", "height_ratios": (1, 1.25, 0.8)}
    figure, slots = panels(7.4, rows=3, columns=columns, squeeze=False, **options)
    for column, n in zip(slots.T, data.n.values, strict=True):
        family = data.sel(n=n)
        draw_stability(column[0], family)
        draw_height(column[1], family)
        draw_window(column[2], family)
        column[0].set_title(label(n=n))
        column[2].set_xlabel("restitution coefficient $r$")
    given = parameters(data)
    percent = f"{100 * given['tolerance']:g} %"
    ranges = "position of $\\Lambda$ from saddle-node (0)\nto period doubling (1), arcsine scale"
    answers = "STABLE", f"AS HIGH WITHIN {percent}"
    for axes, answer in zip(slots[:2, 0], answers, strict=True):
        axes.set_yticks(places(xr.DataArray([*POSITIONS])), [f"{each:g}" for each in POSITIONS])
        axes.set_ylim(0, np.pi / 2)
        axes.set_ylabel(f"{answer}\n{ranges}")
    below = slots[2, 0]
    below.set_yticks(np.sqrt(BELOW), [f"{each:g}" for each in BELOW])
    below.set_ylim(np.sqrt(BELOW[-1]), 0)
    below.set_ylabel("NO ORBIT EITHER\n$1-\\Lambda/\\Lambda_{SN}$,\nsquare-root scale")
    rule, paper = NOT_ENOUGH.values()
    entries = {
        r"$\varpi$ from which on, exactly": sample(**EXACT),
        "by the error law": sample(**BY_LAW),
        "the error of the height changes its sign": sample(**JUMP),
        r"$\varpi=1/(n\varepsilon)$ is not enough": Patch(linewidth=0, **rule),
        rf"$\varpi={given['paper']:g}$ of the paper is not enough": Patch(linewidth=0, **paper),
    }
    legend_below(figure, entries, columns=3)
    return figure


def draw_stability(axes: Axes, family: xr.Dataset) -> None:
    """The positions of the period doublings of contacts, above which they are not stable."""
    width = family.period_doubling_amplitude - family.saddle_node_amplitude
    share = family.period_doubling_amplitude / width
    exact = places(1 + family.period_doubling_error * share)
    law = places(1 + family.period_doubling_law * share)
    shade(axes, family, exact, np.pi / 2)
    names = dict(zip(family.level.values, cycle((0.12, 0.28, 0.44)), strict=False))
    draw_levels(axes, exact, law, names)


def draw_window(axes: Axes, family: xr.Dataset) -> None:
    """How far below that of the restitution model the saddle-nodes of contacts are."""
    exact = np.sqrt(-family.saddle_node_error)
    shade(axes, family, exact, 0.0)
    law = np.sqrt(-family.saddle_node_law)
    names = dict(zip(family.level.values, cycle((0.2, 0.5, 0.8)), strict=False))
    draw_levels(axes, exact, law, names)


def draw_height(axes: Axes, family: xr.Dataset) -> None:
    """Contours of the ϖ that the height needs, over the position of Λ.

    They end at the line across which the height leaves the tolerance upwards, where ϖ jumps. Below
    it are the lines up to which the height is too large at one ϖ.
    """
    low = family.saddle_node_amplitude
    width = family.period_doubling_amplitude - low

    def place(lift: xr.DataArray) -> xr.DataArray:
        position = (xr.apply_ufunc(np.hypot, low, lift) - low) / width
        return places(xr.where(lift < 0, -position, position))

    r = family.restitution
    jump = place(family.jump_lift)
    too_high = place(family.too_high_lift)
    shade(axes, family, too_high, 0.0)
    edge = np.maximum(jump.fillna(0), 0)
    above = np.column_stack([np.append(r, [r[-1], r[0]]), np.append(edge, [np.pi / 2, np.pi / 2])])
    for name, look in {"lower_threshold_by_law": BY_LAW, "lower_threshold": EXACT}.items():
        needed = finer(family[name].assign_coords(position=places(family.position)), "position")
        colours: Look = {"colors": look["color"], "linewidths": look["linewidth"]}
        lines = axes.contour(r, needed.position, needed, levels=LEVELS, **colours)
        lines.set_clip_path(Path(above), axes.transData)
    for text in axes.clabel(lines, fontsize=6.5, fmt="%g", manual=[*label_points(lines)]):
        # The name hides the wide line as well.
        text.set(bbox=ON_LINE["bbox"], zorder=4)
    stiff = family.level >= family.jump_ratio
    law = place(family.too_high_lift_by_law)
    draw_levels(axes, too_high.where(stiff), law.where(stiff), TOO_HIGH)
    axes.plot(r, jump, **JUMP)


def finer(data: xr.DataArray, dimension: str) -> xr.DataArray:
    """A smooth variable with four times as many samples along a dimension, by cubic splines, with
    this dimension first.
    """
    count = data.sizes[dimension]
    numbers = np.linspace(0, count - 1, 4 * count - 3)
    at = np.interp(numbers, np.arange(count), data[dimension])
    return data.interp({dimension: at}, method="cubic").transpose(dimension, ...)


def label_points(lines: ContourSet) -> Iterator[np.ndarray]:
    """A point on the longest line of each level, away from the edges and from its neighbours."""
    longest = [max(of_level, key=len, default=np.empty(0)) for of_level in lines.allsegs]
    for share, line in zip(cycle((0.4, 0.65)), filter(len, longest), strict=False):
        height = line[:, 1]
        wanted = height.min() + share * np.ptp(height)
        yield line[np.argmin(np.abs(height - wanted))]


def shade(axes: Axes, family: xr.Dataset, lines: xr.DataArray, edge: float) -> None:
    """Shade what lies between an edge and the line of each ϖ that is judged."""
    for judge, look in NOT_ENOUGH.items():
        ratio = float(family.judged_ratio.sel(judge=judge))
        line = lines.sel(level=ratio, method="nearest")
        axes.fill_between(family.restitution, line, edge, linewidth=0, zorder=0, **look)


def draw_levels(
    axes: Axes, exact: xr.DataArray, law: xr.DataArray, names: Mapping[float, float]
) -> None:
    """Lines of one ϖ each over r, exactly and by the law; names are at places r on the lines."""
    for level in exact.level.values:
        line = exact.sel(level=level)
        axes.plot(exact.restitution, law.sel(level=level), **BY_LAW)
        axes.plot(exact.restitution, line, **EXACT)
        if level in names:
            height = float(line.sel(restitution=names[level], method="nearest"))
            if height > ROOM:
                text = f"{level:.4g}" if level >= 100 else f"{level:.3g}"
                axes.text(names[level], height, text, **ON_LINE)


# Other contact laws

LAWS: Mapping[str, Look] = {
    "linear": {"color": COLOURS[0], "linestyle": DASHES[0]},
    "linear, force release": {"color": COLOURS[0], "linestyle": DASHES[4]},
    "hunt-crossley": {"color": COLOURS[1], "linestyle": DASHES[1]},
    "tsuji": {"color": COLOURS[2], "linestyle": DASHES[2]},
    "kuwabara-kono": {"color": COLOURS[3], "linestyle": DASHES[3]},
}


SHORT_TITLES = {
    "max_height": "height",
    "bounce_velocity": "velocity",
    "phase": "phase",
    "saddle_node": "saddle-node",
}
"""The quantities whose errors on other contacts are near to those on the linear one."""

QUANTITIES: Mapping[str, Look] = {
    "max_height": {"marker": "o"},
    "bounce_velocity": {"marker": "s"},
    "phase": {"marker": "^"},
    "saddle_node": {"marker": "x"},
}
"""Marks, because colours tell contacts apart."""
THIN: Look = {"linewidth": 1.1}


def ext_laws(data: xr.Dataset) -> Figure:
    """Errors of both models on contacts of five laws, over D + κ as a share of the cycle.

    Above they are divided by those on the linear contact. Below are the errors themselves, of the
    period doubling and of the apparent restitution, which passes through zero, on all contacts,
    and of the other quantities on the linear one.
    """
    figure = Figure(figsize=(WHOLE_WIDTH, 6.0))
    rows: list[Any] = [
        [f"{model} {name}" for name in SHORT_TITLES for _ in range(3)] for model in MODELS
    ]
    bottom = ("period_doubling", "apparent_restitution", "linear")
    slots = figure.subplot_mosaic([*rows, [name for name in bottom for _ in range(4)]])
    given = parameters(data)
    share = 1 / (2 * given["n"] * data.centroid_ratio)
    quotients = data.relative_error / data.relative_error.sel(law="linear")
    for model in MODELS:
        first = slots[f"{model} max_height"]
        for quantity, words in SHORT_TITLES.items():
            axes = slots[f"{model} {quantity}"]
            for law, look in LAWS.items():
                line = quotients.sel(model=model, law=law, quantity=quantity)
                axes.plot(share, line, **THIN | look)
            if axes is not first:
                axes.sharey(first)
                axes.tick_params(labelleft=False)
            axes.set_title(words if model == "restitution" else "")
        first.set_ylabel(f"{model} model:\nerror / that on the\nlinear contact")
    for name in bottom[:2]:
        draw_on_all(slots[name], data.sel(quantity=name), share)
    draw_linear(slots["linear"], data, share)
    for axes in slots.values():
        axes.set(xscale="log", xlim=(share.min(), share.max()))
    for name in bottom:
        slots[name].set_xlabel(r"share $(D+\kappa)/(2\pi n)$")
        slots[name].set_ylim(1e-7, 1)
        slots[name].tick_params(labelleft=name == bottom[0])
    slots[bottom[0]].set_ylabel("relative error")
    figure.suptitle(title(data, "n", "restitution", "amplitude"), fontsize="medium")
    # The places of names depend on the layout.
    figure.draw_without_rendering()
    for model in MODELS:
        last = quotients.sel(model=model, quantity="saddle_node").isel(centroid_ratio=0)
        names = [
            (LAW_NAMES[law], float(last.sel(law=law)), str(look["color"]))
            for law, look in LAWS.items()
        ]
        name_at_right(slots[f"{model} saddle_node"], names)
    return figure


def draw_on_all(axes: Axes, part: xr.Dataset, share: xr.DataArray) -> None:
    """The errors of a quantity on all contacts, which leave the panel at their zeros."""
    per_cycle = float(share[0] * part.centroid_ratio[0])
    for law, model in np.ndindex(part.sizes["law"], part.sizes["model"]):
        one = part.isel(law=law, model=model)
        known = one.relative_error.notnull().values
        ratio = part.centroid_ratio.values[known]
        ratio, error = with_zero(ratio, one.relative_error.values[known], float(one.law_error_zero))
        axes.plot(per_cycle / ratio, error, **THIN | LAWS[str(one.law.values)])
    axes.set(yscale="log", title=TITLES[str(part["quantity"].values)])


def draw_linear(axes: Axes, data: xr.Dataset, share: xr.DataArray) -> None:
    """Errors on the linear contact, with slopes 1 and 2 above."""
    for quantity, look in QUANTITIES.items():
        for model in MODELS:
            error = data.relative_error.sel(model=model, law="linear", quantity=quantity)
            name = SHORT_TITLES[quantity] if model == "restitution" else None
            apart: Look = {"markersize": 3.5, "markevery": 0.1}
            axes.plot(share, error, label=name, **THIN | LAWS["linear"] | apart | look)
    for slope in (1, 2):
        axes.plot(share, 6 * share**slope, **GUIDE)
    axes.set(yscale="log", title="linear contact")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    beside: Look = {"fontsize": 7, "transform": axes.transAxes}
    axes.text(0.03, 0.93, "restitution model", **beside)
    axes.text(0.5, 0.12, "corrected model", **beside)


# What a phase tells

WAVES: Mapping[str, Look] = {
    "sine": {"color": COLOURS[0], "marker": "o"},
    "three harmonics": {"color": COLOURS[1], "marker": "s"},
    "skewed": {"color": COLOURS[3], "marker": "^"},
}


def ext_phase(data: xr.Dataset) -> Figure:
    """Touches of exact orbits in the plane (X, Y), and the velocity of the table there.

    On the left are the lines of the restitution model and of the error law for two durations. On
    the right the velocity is that at the touch (open) and later by θ (filled), for tables of three
    waveforms. By the law the second one is the level (C - s)/C.
    """
    figure, (plane, level) = panels(2.9, columns=2, width_ratios=(1, 1.35))
    line = float(data.restitution_line)
    top = 1.08 * float(data.touch_y.max())
    plane.plot([line, line], [0, top], color=COLOURS[0], label="restitution model")
    for share, colour, marker in zip(data.shown_share.values, COLOURS[1:], "osD^", strict=False):
        one = data.sel(shown_share=share)
        across = float(one.line_level)
        angle = float(one.line_angle)
        # X cos θ - Y sin θ = C - s.
        ends = [across / np.cos(angle) + y * np.tan(angle) for y in (0, top)]
        plane.plot(ends, [0, top], color=colour, linestyle=DASHES[3])
        name = f"$D/(2\\pi)$ = {100 * share:g} %"
        plane.plot(one.touch_x, one.touch_y, marker, color=colour, markersize=3.5, label=name)
    given = parameters(data)
    plane.set(
        xlabel=r"$X=\Lambda\,\cos\,\varphi$", ylabel=r"$Y=\Lambda\,\sin\,\varphi$", ylim=(0, top)
    )
    plane.set_title(label(n=1, restitution=given["shown_restitution"]))
    last = data.isel(shown_share=-1)
    for waveform, look in WAVES.items():
        one = data.sel(waveform=waveform)
        mark: Look = {"markersize": 3.5, "linestyle": "none", **look}
        level.plot(one.steepness, one.touch_slope, fillstyle="none", **mark)
        level.plot(one.steepness, one.turned_slope, label=waveform, **mark)
    level.axhline(1, color=COLOURS[0])
    level.axhline(float(last.line_level) / line, **GUIDE)
    right = float(data.steepness.max())
    notes: Look = {"fontsize": 7, "ha": "right"}
    level.annotate("restitution model", (right, 1.002), va="bottom", **notes)
    below = float(last.line_level) / line - 0.006
    level.annotate(r"error law, $(C-s)/C$", (right, below), va="top", **notes)
    share = 100 * float(data.shown_share[-1])
    level.set_title(f"open: at the touch; filled: later by $\\theta$; $D/(2\\pi)$ = {share:g} %")
    level.set(xlabel=r"$\max\,w'/C$", ylabel=r"velocity of the table $w'/C$")
    level.set_ylim(bottom=below - 0.03)
    plane.legend(fontsize=7, loc="lower right")
    level.legend(fontsize=7)
    return figure


FIGURES: Mapping[str, Callable[[xr.Dataset], Figure]] = {
    "ext_impact": ext_impact,
    "ext_instant": ext_instant,
    "ext_orders": ext_orders,
    "ext_map": ext_map,
    "ext_laws": ext_laws,
    "ext_phase": ext_phase,
}


def draw(name: str, data: xr.Dataset) -> Figure:
    """A figure by name from its dataset, in the style of the replication."""
    with style():
        return FIGURES[name](data)

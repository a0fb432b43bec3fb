"""The figures, each a function of its dataset, in the style of those of the replication."""

from collections.abc import Callable, Mapping
from itertools import cycle

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from carbonelli2011.curves import TABLE, along_ratio, label, title
from paper_replication.datasets import parameters
from paper_replication.drawing import (
    COLOURS,
    DASHES,
    GUIDE,
    Look,
    legend_below,
    panels,
    sample,
    style,
)
from studies.variables import LAW_NAMES

TITLES: Mapping[str, str] = {
    "max_height": "maximum height",
    "bounce_velocity": "bouncing-off velocity",
    "phase": r"phase of touch $\varphi$",
    "apparent_restitution": "apparent restitution",
    "saddle_node": r"$\Lambda$ of the saddle-node",
    "period_doubling": r"$\Lambda$ of the period doubling",
}
"""The quantities whose errors are shown, as titles of panels."""

WHOLE_WIDTH = 7.0
"""Width in inches of a figure with several columns of panels."""

CONTACT = COLOURS[1]
MODELS: Mapping[str, Look] = {
    "restitution": {"color": COLOURS[0], "linewidth": 1.0},
    "corrected": {"color": COLOURS[3], "linestyle": (0, (4, 1.5))},
}
"""The lines of both models of impacts as instants."""


# The three answers

BRANCHES: Mapping[str, Look] = {
    "restitution": {"color": COLOURS[0], "linewidth": 1.2},
    "contact": {"color": COLOURS[1], "linewidth": 1.8},
    "law": {"color": COLOURS[4], "linewidth": 3.6, "alpha": 0.6},
}
"""The branches of both models and that by the error law, which is drawn below them."""
BRANCH_NAMES = {
    "law": "error law",
    "restitution": "restitution model",
    "contact": "contact",
}
WAVES: Mapping[str, Look] = {
    "sine": {"color": COLOURS[0], "linestyle": DASHES[0], "marker": "o"},
    "third harmonic": {"color": COLOURS[2], "linestyle": DASHES[2], "marker": "D"},
    "three harmonics": {"color": COLOURS[1], "linestyle": DASHES[1], "marker": "s"},
    "skewed": {"color": COLOURS[3], "linestyle": DASHES[3], "marker": "^"},
}
"""Motions of the table."""


def ext_answers(data: xr.Dataset) -> Figure:
    """A branch of orbits in both models and by the error law; shifts of the period doubling."""
    figure, (branch, shifts) = panels(3.3, width=WHOLE_WIDTH, columns=2, width_ratios=(1.2, 1))
    for model, name in BRANCH_NAMES.items():
        one = data.sel(branch=model)
        look = BRANCHES[model]
        branch.plot(
            one.branch_amplitude.where(one.branch_stable), one.branch_phase, label=name, **look
        )
        if model != "law":
            unstable = look | {"linestyle": (0, (2, 1.5)), "linewidth": 1.0}
            branch.plot(
                one.branch_amplitude.where(~one.branch_stable), one.branch_phase, **unstable
            )
        for kind, mark in (("saddle_node", "o"), ("period_doubling", "D")):
            if model == "law":
                continue
            place = float(one[f"{kind}_amplitude"]), float(one[f"{kind}_phase"])
            filled = "white" if kind == "saddle_node" else look["color"]
            branch.plot(
                *place, mark, color=look["color"], markerfacecolor=filled, markersize=5, zorder=5
            )
    ends = [
        float(data.saddle_node_amplitude.sel(branch=model)) for model in ("contact", "restitution")
    ]
    branch.axvspan(*ends, facecolor="0.88", zorder=0)
    high = 1.1 * float(data.period_doubling_phase.max())
    beside: Look = {"textcoords": "offset points", "fontsize": 7}
    window = "window:\nonly the contact\nhas orbits"
    branch.annotate(window, (ends[0], high), (-4, -2), ha="right", va="top", **beside)
    turned = data.sel(branch="contact")
    place = float(turned.period_doubling_amplitude), float(turned.period_doubling_phase)
    branch.annotate("period doubling", place, (-20, -14), **beside)
    branch.set(xlabel=r"amplitude $\Lambda$", ylabel=r"phase of the touch $\varphi$")
    branch.set(ylim=(-0.7 * high, high), xlim=(0.3 * ends[1], float(data.branch_amplitude.max())))
    branch.set_title(title(data, "n", "restitution", "frequency_ratio"))
    branch.legend(fontsize=7, loc="lower right")
    for wave, look in WAVES.items():
        one = data.sel(waveform=wave)
        line = {key: value for key, value in look.items() if key != "marker"}
        law = one.doubling_coefficient.where(abs(one.doubling_coefficient) < 1)
        shifts.plot(data.doubling_restitution, law, linewidth=1.2, label=wave, **line)
        shifts.plot(
            data.table_restitution,
            one.table_shift,
            look["marker"],
            color=look["color"],
            markersize=4,
        )
    # The shift on the skewed table has a pole, where its doubling is no longer passed along Λ.
    middle = data.table_shift
    shifts.set_ylim(1.3 * float(middle.min()), 2.5 * float(middle.max()))
    shifts.axhline(0, **GUIDE)
    shifts.set(
        xlabel="restitution coefficient $r$",
        ylabel=r"relative shift of $\Lambda_{PD}$ times $\varpi$",
    )
    shifts.set_title("period doubling on four tables")
    shifts.legend(fontsize=7)
    return figure


# One contact

RELEASES: Mapping[str, Look] = {
    "displacement": {"color": COLOURS[0]},
    "force": {"color": COLOURS[1], "linestyle": DASHES[1], "linewidth": 1.6},
}


def ext_impact(data: xr.Dataset) -> Figure:
    """The force in one contact with both ends; restitution coefficient and duration over ζ."""
    figure, (force, restitution, duration) = panels(2.5, width=WHOLE_WIDTH, columns=3)
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
        text = f"$\\varpi D={end[0]:.2f}$\n$r={float(one.end_restitution):.2f}$"
        note: Look = places[release] | {"textcoords": "offset points", "color": look["color"]}
        force.annotate(text, end, **note)
    force.set(xlabel=r"time since the touch times $\varpi$", ylabel=r"force $F/(\varpi v)$")
    force.set_xticks(np.pi * np.arange(3) / 2, ["0", r"$\pi/2$", r"$\pi$"])
    force.set_title("one contact")
    force.margins(y=0.3)
    damping = r"damping ratio $\zeta$"
    restitution.set(xlabel=damping, ylabel="$r$", title="restitution coefficient", ylim=(0, 1.05))
    duration.set(xlabel=damping, ylabel=r"$\varpi D/\pi$", title="duration $D$", ylim=(0, 1.3))
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
    below.annotate(r"$\psi-\varphi$", (meeting, 0), (3, 3), textcoords="offset points")
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
    top.annotate(
        r"$\approx t_c$", (meeting / 2, under), (0, 3), textcoords="offset points", ha="center"
    )
    top.annotate("", (meeting, low), (meeting, level), arrowprops=arrow)
    middle = low + 0.86 * (level - low)
    top.annotate(
        r"$\approx v\,t_c$", (meeting, middle), (5, 0), textcoords="offset points", va="center"
    )
    top.axvline(0, **GUIDE)
    top.set(ylabel="height")
    top.set_ylim(low - 0.25 * depth, low + 1.6 * depth)
    top.set_title(title(data, "n", "restitution", "amplitude", "frequency_ratio"))
    top.margins(x=0)
    below.set(xlabel=r"time since the touch, $\tau-\varphi$", ylabel="force / weight")
    legend_below(figure)
    return figure


def ext_contact_time(data: xr.Dataset) -> Figure:
    """Contact times of balls along the table's frequency, and the longest one that is stiff."""
    figure, axes = panels(3.4)
    given = parameters(data)
    ratio = f"{given['frequency_ratio']:g}"
    limit = rf"$\varpi={ratio}$: 1/{2 * given['frequency_ratio']:g} of a period"
    balls = data.ball_name.values
    for name, colour, dashes in zip(balls, COLOURS, DASHES, strict=False):
        one = data.sel(ball_name=name)
        look: Look = {"color": colour, "linestyle": dashes}
        look["label"] = f"{name}, {label(restitution=one.restitution)}"
        axes.plot(data.frequency, 1e3 * one.contact_time, **look)
        place = float(one.stiff_frequency), 5e2 / given["frequency_ratio"] / one.stiff_frequency
        axes.plot(*place, "o", color=colour, markersize=4, zorder=5)
        note: Look = {"xytext": (0, 7), "textcoords": "offset points", "color": colour}
        axes.annotate(f"{place[0]:.3g} Hz", place, **note)
    axes.plot(data.frequency, 1e3 * data.longest_contact_time, label=limit, **GUIDE)
    axes.set(xscale="log", yscale="log", xlim=data.frequency[[0, -1]])
    axes.set(xlabel="frequency of the table in Hz", ylabel="contact time in ms")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_title(label(n=given["n"]))
    legend_below(figure, columns=2)
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


SHOWN = ("max_height", "saddle_node", "period_doubling")
"""The quantities whose orders are drawn; the others have the same orders."""


def ext_orders(data: xr.Dataset) -> Figure:
    """Errors of both models and what the error law leaves, along ϖ, with their orders in 1/ϖ.

    The last panel has those of the height at the saddle-node of the restitution model.
    """
    figure, slots = panels(2.9, width=WHOLE_WIDTH, columns=4, sharex=True, sharey=True)
    *panels_of, at_node = slots.flat
    ratio = data.frequency_ratio
    orbit = data.sel(place="orbit")
    zeros = {"restitution": data.error_zero, "corrected": data.corrected_error_zero}
    for quantity, axes in zip(SHOWN, panels_of, strict=True):
        part = orbit.sel(quantity=quantity)
        orders = []
        for order, (model, look) in enumerate(MODELS.items(), 1):
            error = part.relative_error.sel(model=model).values
            zero = float(zeros[model].sel(quantity=quantity))
            axes.plot(*with_zero(ratio.values, error, zero), label=f"{model} model", **look)
            draw_slope(axes, ratio, error, order)
            orders.append((part.order.sel(model=model), look))
        axes.plot(ratio, part.law_left, label="left by the error law", **LAW)
        note_orders(axes, [*orders, (part.law_order, LAW)])
        axes.set_title(TITLES[quantity])
    node = data.sel(place="saddle-node", quantity="max_height")
    rigid = MODELS["restitution"]
    for left, slope, look in ((node.node_error, 0.5, rigid), (node.law_left, 1.5, LAW)):
        at_node.plot(ratio, left, **look)
        draw_slope(at_node, ratio, left.values, slope)
    note_orders(at_node, [(node.node_order, rigid), (node.law_order, LAW)])
    at_node.set_title(r"height at $\Lambda=C$")
    for axes in slots.flat:
        axes.set(yscale="log")
        along_ratio(axes, ratio)
        axes.set_xticks([1, 100, 10000])
        # Errors are below 1; the orders have the room above.
        axes.set_ylim(1e-10, 1e4)
    slots.flat[0].set_ylabel("relative error")
    figure.suptitle(title(data, "n", "restitution", "amplitude"), fontsize="medium")
    lines, names = slots.flat[0].get_legend_handles_labels()
    entries = dict(zip(names, lines, strict=True)) | {
        "slopes of the orders expected": sample(**GUIDE)
    }
    legend_below(figure, entries, columns=4)
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

LEVELS = (15, 20, 30, 40, 50, 60, 80)
STIFFER = (200, 1000)
"""Contours of the ϖ from which on the height is right, below that of the paper and above it."""

EXACT: Look = {"color": "black", "linewidth": 0.8}
BY_LAW: Look = {"color": COLOURS[4], "linewidth": 2.6}
NOT_ENOUGH: Look = {"facecolor": "0.88", "hatch": "/////", "edgecolor": "0.6", "linewidth": 0}
"""Where the ϖ of the paper is not enough."""
ON_LINE: Look = {
    "ha": "center",
    "va": "center",
    "fontsize": 6.5,
    "clip_on": True,
    "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 0.5},
}


def places(position: xr.DataArray) -> xr.DataArray:
    """Places on the axis of positions, arcsin √p."""
    return xr.apply_ufunc(np.arcsin, np.sqrt(position.clip(0, 1)))


def ext_map(data: xr.Dataset) -> Figure:
    """From which ϖ on a contact is stable and as high, exactly and by the error law.

    The stability is above, as lines of one ϖ each above which the contact has doubled; the height
    is below, as contours.
    """
    columns = data.sizes["n"]
    options: Look = {"sharex": True, "sharey": True, "height_ratios": (1, 1.2)}
    figure, slots = panels(
        5.6, width=WHOLE_WIDTH, rows=2, columns=columns, squeeze=False, **options
    )
    paper = parameters(data)["paper"]
    for (stable, high), n in zip(slots.T, data.n.values, strict=True):
        family = data.sel(n=n)
        draw_stability(stable, family, paper)
        draw_height(high, family, paper)
        stable.set_title(label(n=n))
        high.set_xlabel("restitution coefficient $r$")
    percent = f"{100 * parameters(data)['tolerance']:g} %"
    answers = "STABLE", f"AS HIGH WITHIN {percent}"
    for axes, answer in zip(slots[:, 0], answers, strict=True):
        axes.set_yticks(
            places(xr.DataArray([*POSITIONS])), [f"{position:g}" for position in POSITIONS]
        )
        axes.set_ylim(0, np.pi / 2)
        axes.set_ylabel(f"{answer}\nposition of $\\Lambda$")
    entries = {
        r"smallest sufficient $\varpi$, exact": sample(**EXACT),
        "by the error law": sample(**BY_LAW),
        rf"$\varpi={paper:g}$ of the paper is not enough": Patch(**NOT_ENOUGH),
    }
    legend_below(figure, entries, columns=3)
    return figure


def draw_stability(axes: Axes, family: xr.Dataset, paper: float) -> None:
    """The positions of the period doublings of contacts, above which they are not stable."""
    width = family.period_doubling_amplitude - family.saddle_node_amplitude
    share = family.period_doubling_amplitude / width
    exact = places(1 + family.period_doubling_error * share)
    law = places(1 + family.period_doubling_law * share)
    r = family.restitution
    axes.fill_between(r, exact.sel(level=paper), np.pi / 2, zorder=0, **NOT_ENOUGH)
    for level, at in zip(family.level.values, cycle((0.12, 0.28, 0.44)), strict=False):
        axes.plot(r, law.sel(level=level), **BY_LAW)
        line = exact.sel(level=level)
        axes.plot(r, line, **EXACT)
        axes.text(at, float(line.sel(restitution=at, method="nearest")), f"{level:g}", **ON_LINE)


def draw_height(axes: Axes, family: xr.Dataset, paper: float) -> None:
    """Contours of the ϖ that the height needs. Next to the saddle-node the height leaves the
    tolerance upwards first; the ϖ jumps to a larger one there, where contours end.
    """
    r = family.restitution
    place = places(family.position)
    exact = family.error_threshold.transpose("position", "restitution")
    law = family.threshold_by_law.transpose("position", "restitution")
    axes.contourf(r, place, exact, levels=[paper, np.inf], colors="none", hatches=["/////"])
    for needed, look in ((law, BY_LAW), (exact, EXACT)):
        drawn: Look = {"colors": look["color"], "linewidths": look["linewidth"]}
        jumps = needed.shift(position=-1) < needed / 2
        before = jumps[::-1].cumsum("position")[::-1] > 0
        lower = axes.contour(r, place, needed.where(~before), levels=LEVELS, **drawn)
        upper = axes.contour(r, place, needed.where(before), levels=STIFFER, **drawn)
    for lines in (lower, upper):
        for text in axes.clabel(lines, fontsize=6.5, fmt="%g", inline_spacing=1):
            # The name hides the wide line as well.
            text.set(bbox=ON_LINE["bbox"], zorder=4)


# Other contact laws

LAWS: Mapping[str, Look] = {
    "linear": {"color": COLOURS[0], "linestyle": DASHES[0]},
    "linear, force release": {"color": COLOURS[0], "linestyle": DASHES[4]},
    "hunt-crossley": {"color": COLOURS[1], "linestyle": DASHES[1]},
    "tsuji": {"color": COLOURS[2], "linestyle": DASHES[2]},
    "kuwabara-kono": {"color": COLOURS[3], "linestyle": DASHES[3]},
}


def ext_laws(data: xr.Dataset) -> Figure:
    """Errors of both models on contacts of five laws, over D + κ as a share of the cycle."""
    shown = ("max_height", "period_doubling")
    figure, slots = panels(3.2, width=WHOLE_WIDTH, columns=2, sharex=True, sharey=True)
    given = parameters(data)
    share = 1 / (2 * given["n"] * data.centroid_ratio)
    for axes, quantity in zip(slots, shown, strict=True):
        draw_on_all(axes, data.sel(quantity=quantity), share)
        axes.set(xscale="log", xlim=(share.min(), share.max()), ylim=(1e-7, 1))
        axes.set_xlabel(r"share $(D+\kappa)/(2\pi n)$")
        axes.tick_params(labelleft=axes is slots[0])
    beside: Look = {"fontsize": 7, "transform": slots[0].transAxes}
    slots[0].text(0.05, 0.88, "restitution model, constant $r$", **beside)
    slots[0].text(0.5, 0.2, "corrected model", **beside)
    slots[0].set_ylabel("relative error")
    figure.suptitle(title(data, "n", "restitution", "amplitude"), fontsize="medium")
    entries = {LAW_NAMES[law]: sample(**look) for law, look in LAWS.items()}
    legend_below(figure, entries, columns=3)
    return figure


def draw_on_all(axes: Axes, part: xr.Dataset, share: xr.DataArray) -> None:
    """The errors of a quantity on all contacts, which leave the panel at their zeros."""
    per_cycle = float(share[0] * part.centroid_ratio[0])
    for law, model in np.ndindex(part.sizes["law"], part.sizes["model"]):
        one = part.isel(law=law, model=model)
        known = one.relative_error.notnull().values
        ratio = part.centroid_ratio.values[known]
        ratio, error = with_zero(ratio, one.relative_error.values[known], float(one.law_error_zero))
        axes.plot(per_cycle / ratio, error, linewidth=1.1, **LAWS[str(one.law.values)])
    axes.set(yscale="log", title=TITLES[str(part["quantity"].values)])


# What a phase tells


def ext_phase(data: xr.Dataset) -> Figure:
    """Touches of exact orbits in the plane (w′, -w″), and the velocity of the table there.

    On the left are the lines of the restitution model and of the error law for two durations. On
    the right the velocity is that at the touch (open) and later by θ (filled), for tables of three
    waveforms. By the law the second one is the level (C - s)/C.
    """
    figure, (plane, level) = panels(2.9, width=WHOLE_WIDTH, columns=2, width_ratios=(1, 1.35))
    line = float(data.restitution_line)
    top = 1.08 * float(data.touch_y.max())
    plane.plot([line, line], [0, top], color=COLOURS[0], label="restitution model")
    for share, colour, marker in zip(data.shown_share.values, COLOURS[1:], "osD^", strict=False):
        one = data.sel(shown_share=share)
        across = float(one.line_level)
        angle = float(one.line_angle)
        # w′ cos θ + w″ sin θ = C - s.
        ends = [across / np.cos(angle) + y * np.tan(angle) for y in (0, top)]
        plane.plot(ends, [0, top], color=colour, linestyle=DASHES[3])
        name = f"$D/(2\\pi)$ = {100 * share:g} %"
        plane.plot(one.touch_x, one.touch_y, marker, color=colour, markersize=3.5, label=name)
    given = parameters(data)
    plane.set(
        xlabel=r"$w'=\Lambda\,\cos\,\varphi$",
        ylabel=r"$-w''=\Lambda\,\sin\,\varphi$",
        ylim=(0, top),
    )
    plane.set_title(label(n=1, restitution=given["shown_restitution"]))
    last = data.isel(shown_share=-1)
    for waveform in data.waveform.values:
        one = data.sel(waveform=waveform)
        look = WAVES[waveform]
        mark: Look = {"markersize": 3.5, **look, "linestyle": "none"}
        level.plot(one.steepness, one.touch_slope, fillstyle="none", **mark)
        level.plot(one.steepness, one.turned_slope, label=waveform, **mark)
    level.axhline(1, color=COLOURS[0])
    level.axhline(float(last.line_level) / line, **GUIDE)
    right = float(data.steepness.max())
    notes: Look = {"fontsize": 7, "ha": "right"}
    level.annotate("restitution model", (right, 1.002), va="bottom", **notes)
    below = float(last.line_level) / line - 0.012
    level.annotate(r"error law, $(C-s)/C$", (right, below), va="top", **notes)
    share = 100 * float(data.shown_share[-1])
    level.set_title(f"open: at the touch; filled: later by $\\theta$; $D/(2\\pi)$ = {share:g} %")
    level.set(xlabel=r"$\max\,w'/C$", ylabel=r"velocity of the table $w'/C$")
    level.set_ylim(bottom=below - 0.03)
    plane.legend(fontsize=7, loc="lower right")
    level.legend(fontsize=7)
    return figure


# Laid balls

CONTACTS: Mapping[str, int] = {
    "1 contact": 1,
    "2": 2,
    "3": 3,
    "4": 4,
    "5 to 7": 5,
    "8 to 11": 8,
    "12 to 17": 12,
    "18 or more": 18,
}
"""Colours of motions that repeat in each period, by the smallest number of contacts."""

SHADES = matplotlib.colormaps["viridis"](np.linspace(0.98, 0.1, len(CONTACTS)))
RESTS, ENDLESS, SEVERAL, FLYING, UNKNOWN = "0.9", "black", COLOURS[2], "#d95f9b", "white"
AREAS = (UNKNOWN, RESTS, *SHADES, SEVERAL, FLYING, ENDLESS)
"""Colours of a map by the number of their kind of motion."""


def kinds_of_motion(impacts: xr.DataArray, periods: xr.DataArray) -> xr.DataArray:
    """Numbers of the colours in `AREAS`, without those of the flying orbit and of rigid balls."""
    count = sum((impacts >= least).astype(int) for least in CONTACTS.values())
    return xr.where(periods == 1, 1 + count, xr.where(periods > 1, 2 + len(CONTACTS), 0))


def ext_laid(data: xr.Dataset) -> Figure:
    """Contacts in a period of laid balls over ϖ and Λ, for two r, and the heights of their hops."""
    figure, (*maps, heights) = panels(3.5, width=WHOLE_WIDTH, columns=3)
    for axes, r in zip(maps, data.restitution, strict=True):
        draw_laid(axes, data.sel(restitution=r))
        axes.set_title(label(restitution=r))
        axes.tick_params(labelleft=axes is maps[0])
    maps[0].set_ylabel(r"amplitude $\Lambda$")
    draw_hops(heights, data.isel(restitution=0))
    entries = {
        "stays on the table": Patch(facecolor=RESTS),
        **{name: Patch(facecolor=shade) for name, shade in zip(CONTACTS, SHADES, strict=True)},
        "chatters and sticks (rigid)": Patch(facecolor=ENDLESS),
        "flying 1-T orbit": Patch(facecolor=FLYING),
        "several periods": Patch(facecolor=SEVERAL),
        "unknown": Patch(facecolor=UNKNOWN, edgecolor="0.5", linewidth=0.6),
        r"$\Lambda_{SD}$": sample(linewidth=1.4),
    }
    legend_below(figure, entries, columns=7)
    return figure


def draw_laid(axes: Axes, one: xr.Dataset) -> None:
    """A map of the kinds of motion on contacts, with a strip of those in the restitution model."""
    number = len(AREAS)
    look: Look = {
        "cmap": ListedColormap(AREAS),
        "vmin": -0.5,
        "vmax": number - 0.5,
        "rasterized": True,
    }
    look["shading"] = "nearest"
    kinds = kinds_of_motion(one.impacts, one.periods)
    flies = np.isclose(one.hop, one.flying_hop, rtol=1e-3) & (one.periods == 1)
    kinds = kinds.where(~flies, number - 2).transpose("amplitude", ...)
    axes.pcolormesh(one.frequency_ratio, one.amplitude, kinds, **look)
    axes.plot(one.frequency_ratio, one.threshold_amplitude, color="black", linewidth=1.4)
    along_ratio(axes, one.frequency_ratio)
    strip = axes.inset_axes((1.03, 0, 0.07, 1), sharey=axes)
    kinds = kinds_of_motion(0 * one.rigid_periods, one.rigid_periods)
    kinds = kinds.where(~((one.rigid_periods == 1) & (one.rigid_hop > 0)), number - 1)
    strip.pcolormesh([0, 1], one.amplitude, np.stack([kinds, kinds], axis=1), **look)
    strip.set_title("rigid", fontsize=7)
    strip.set_xticks([])
    strip.tick_params(left=False, labelleft=False)
    strip.spines[:].set_visible(False)
    axes.set_ylim(one.amplitude.values[[0, -1]])


def draw_hops(axes: Axes, one: xr.Dataset) -> None:
    """Heights of the hops along Λ, and those of the flying orbit on the stiffest contact."""
    # Before the lines: balls that stay on the table have no height above zero to scale.
    axes.set(yscale="log", ylim=(1e-4, 20))
    wide: Look = {"color": "0.75", "linewidth": 4, "solid_capstyle": "butt"}
    axes.plot(one.amplitude, one.rigid_hop.where(one.rigid_periods == 1), label="rigid", **wide)
    for ratio, colour, dashes in zip(one.shown_ratio, COLOURS[1:], DASHES, strict=False):
        hop = one.shown_hop.sel(shown_ratio=ratio)
        look: Look = {"color": colour, "linestyle": dashes, "linewidth": 1.1}
        axes.plot(one.amplitude, hop, label=label(frequency_ratio=ratio), **look)
    flying = one.flying_hop.isel(frequency_ratio=-1)
    axes.plot(one.amplitude, flying, color=FLYING, linewidth=1.6, label="flying 1-T orbit")
    axes.set_xlabel(r"amplitude $\Lambda$")
    axes.set_ylabel(r"height of the hop, $\max\,\delta$")
    axes.set_title(label(restitution=one.restitution))
    axes.legend(fontsize=7)


FIGURES: Mapping[str, Callable[[xr.Dataset], Figure]] = {
    "ext_answers": ext_answers,
    "ext_impact": ext_impact,
    "ext_instant": ext_instant,
    "ext_contact_time": ext_contact_time,
    "ext_orders": ext_orders,
    "ext_map": ext_map,
    "ext_laws": ext_laws,
    "ext_phase": ext_phase,
    "ext_laid": ext_laid,
}


def draw(name: str, data: xr.Dataset) -> Figure:
    """A figure by name from its dataset, in the style of the replication."""
    with style():
        figure = FIGURES[name](data)
        figure.set_label(data.attrs["title"])
        return figure

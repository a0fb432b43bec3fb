"""The figures, each a function of its dataset, in the style of those of the replication."""

from collections.abc import Callable, Iterator, Mapping
from itertools import cycle

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from bouncing_ball.datasets import parameters
from bouncing_ball.drawing import (
    COLOURS,
    DASHES,
    GUIDE,
    TABLE,
    Look,
    along_ratio,
    label,
    legend_below,
    panels,
    sample,
    style,
    title,
)
from studies.variables import LAW_NAMES

TITLES: Mapping[str, str] = {
    "max_height": r"greatest height $\max\,z$",
    "bounce_velocity": r"bouncing-off velocity $z'_b$",
    "phase": r"phase of impact $\varphi$",
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
    force.fill_between(data.time, pulls, label="the table pulls", **body)
    # The displacement release is at the end of the curve, and the force release at its zero.
    heights = {"displacement": float(load[-1]), "force": 0.0}
    places: dict[str, Look] = {
        "displacement": {"xytext": (-7, 0), "ha": "right", "va": "center"},
        "force": {"xytext": (2, 6), "ha": "left", "va": "bottom"},
    }
    for release, look in RELEASES.items():
        one = data.sel(release=release)
        restitution.plot(data.damping_ratio, one.restitution, label=f"{release} release", **look)
        duration.plot(data.damping_ratio, one.contact_duration / np.pi, **look)
        end = float(one.contact_end), heights[release]
        force.plot(*end, "o", color=look["color"], markersize=4, zorder=5)
        text = f"$r={float(one.end_restitution):.2f}$"
        note: Look = places[release] | {"textcoords": "offset points", "color": look["color"]}
        force.annotate(text, end, **note)
    force.set(xlabel=r"time $\omega t$,  $\omega = \sqrt{k/m}$", ylabel=r"force $/\,(m\omega v)$")
    force.set_xticks(np.pi * np.arange(3) / 2, ["0", r"$\pi/2$", r"$\pi$"])
    force.set_title("one contact")
    force.margins(y=0.12)
    damping = r"damping ratio $\zeta = c\,/\,(2\sqrt{km})$"
    restitution.set(xlabel=damping, ylabel="$r$", title="restitution coefficient", ylim=(0, 1.05))
    duration.set(xlabel=damping, ylabel=r"$\omega D/\pi$", title="duration", ylim=(0, 1.3))
    legend_below(figure, columns=3)
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
    top.plot(time, data.table, color=TABLE, label="table")
    top.plot(time, data.ball, color=CONTACT, label="ball")
    top.plot(time[touching], data.ball[touching], color=CONTACT, linewidth=2.4)
    meeting = float(data.meeting_time)
    low = float(data.meeting_height)
    top.plot(meeting, low, "o", color="black", markersize=4, zorder=5)
    force = data.contact_force[touching]
    below.fill_between(time[touching], force, facecolor="#bfdbec", edgecolor=CONTACT)
    for axes in (top, below):
        axes.axvline(meeting, **GUIDE)
    below.annotate("$t^*$", (meeting, 0), (3, 3), textcoords="offset points")
    depth = float(data.table[touching].max()) - low
    top.set(ylabel="height", ylim=(low - 0.12 * depth, low + 1.6 * depth))
    top.set_title(title(data, "n", "restitution", "amplitude", "frequency_ratio"))
    top.margins(x=0)
    below.set(xlabel=r"time since the start of contact $\tau$", ylabel="contact force")
    legend_below(figure)
    return figure


# Errors of both models

QUANTILES = (0.05, 0.5, 0.95)
"""The median of measured orders, and the ends of their middle 90 %."""

LAW: Look = {"color": COLOURS[4], "linewidth": 1.0}
"""What the error law leaves."""

AT_NODE: Look = {"linestyle": (0, (1, 1.2)), "linewidth": 1.6}
"""Errors at the saddle-node of the restitution model."""


def panels_by_quantity(data: xr.Dataset, height: float) -> tuple[Figure, dict[str, Axes]]:
    """Two rows of three panels, one for the errors of each quantity; one may be left over."""
    figure, slots = panels(height, rows=2, columns=3, sharex=True, sharey=True)
    for axes in slots.flat:
        axes.set(yscale="log", ylabel="relative error")
    found = dict(zip(data["quantity"].values.tolist(), slots.flat, strict=False))
    for quantity, axes in found.items():
        axes.set_title(TITLES[quantity])
    return figure, found


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

    The panel of the height has them at the saddle-node of the restitution model, too.
    """
    figure, found = panels_by_quantity(data, 4.6)
    ratio = data.frequency_ratio
    orbit = data.sel(place="orbit")
    zeros = {"restitution": data.error_zero, "corrected": data.corrected_error_zero}
    for quantity, axes in found.items():
        part = orbit.sel(quantity=quantity)
        notes = []
        for order, (model, look) in enumerate(MODELS.items(), 1):
            error = part.relative_error.sel(model=model).values
            zero = float(zeros[model].sel(quantity=quantity))
            axes.plot(*with_zero(ratio.values, error, zero), label=model, **look)
            draw_slope(axes, ratio, error, order)
            notes.append((part.order.sel(model=model), look))
        axes.plot(ratio, part.law_left, label="error law, what it leaves", **LAW)
        notes.append((part.law_order, LAW))
        if quantity == "max_height":
            node = data.sel(place="saddle-node", quantity=quantity)
            for error, slope, look in (
                (node.node_error, 0.5, MODELS["restitution"]),
                (node.law_left, 1.5, LAW),
            ):
                axes.plot(ratio, error, **look | AT_NODE)
                draw_slope(axes, ratio, error.values, slope)
            notes += [(node.node_order, MODELS["restitution"]), (node.law_order, LAW)]
            axes.plot([], [], color=GUIDE["color"], label="at the saddle-node", **AT_NODE)
        note_orders(axes, notes)
        along_ratio(axes, ratio)
        # Errors are below 1 but next to a phase of 0; the orders have the room above.
        axes.set_ylim(1e-11, 1e5)
    given = title(data, "n", "restitution", "amplitude")
    orders = f"orders of {data.sizes['sample']} random orbits, median (and the middle 90 %)"
    figure.suptitle(f"{given}; {orders}", fontsize="medium")
    legend_below(figure)
    return figure


def draw_slope(axes: Axes, ratio: xr.DataArray, error: np.ndarray, order: float) -> None:
    """A guide with the slope of an order in 1/ϖ through the last point of an error."""
    axes.plot(ratio, error[-1] * (ratio[-1] / ratio) ** order, **GUIDE)


def note_orders(axes: Axes, orders: list[tuple[xr.DataArray, Look]]) -> None:
    """Medians of measured orders and their middle 90 %, one below the other at the top right."""
    place: Look = {"transform": axes.transAxes, "ha": "right", "va": "top", "fontsize": 6.5}
    for line, (order, look) in enumerate(orders):
        low, middle, high = order.quantile(QUANTILES).values
        text = f"{middle:.2f} ({low:.2f} to {high:.2f})".replace("-", "−")
        axes.text(0.98, 0.98 - 0.07 * line, text, color=look["color"], **place)


# Map

POSITIONS = (0, 0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1)
"""Positions of Λ in the stable range that are named; the axis is even in their square roots."""

LEVELS = {-1: (15, 20, 25, 30, 40, 50, 60, 70, 80, 90), 1: (200, 1000)}
"""Contours of ϖ where the ball on the contact bounces lower and where it bounces higher."""

RULE: Look = {"colors": "black", "linewidths": 2.0}
JUMP: Look = {"colors": "black", "linewidths": 1.0, "linestyles": [(0, (1, 1.5))]}
FAILS = "#b9d7ea"
ABSENT: Look = {"facecolor": "white", "edgecolor": TABLE, "hatch": "////", "linewidth": 0}
DIFFERS: Look = {"facecolor": "white", "edgecolor": "#b2182b", "hatch": "....", "linewidth": 0}


def ext_map(data: xr.Dataset) -> Figure:
    """Contours of the ϖ that the height needs, over r and the position of Λ in the stable range.

    Above they are those of the contact, below those of the error law. Where the rule of thumb
    ϖ ≥ 1/(nε) fails, the map is shaded. Where the contact has no stable orbit at the ϖ that is
    needed, the upper map is hatched. Contours end at the line across which the error reaches the
    tolerance with the other sign, because ϖ jumps there. The lower map is dotted where its ϖ
    differs much from that above.
    """
    columns = data.sizes["n"]
    figure, slots = panels(5.6, rows=2, columns=columns, sharex=True, sharey=True, squeeze=False)
    tolerance = parameters(data)["tolerance"]
    for column, n in zip(slots.T, data.n.values, strict=True):
        family = data.sel(n=n).transpose("position", "restitution")
        exact, law = column
        exact.patch.set(**ABSENT)
        draw_ratios(exact, family, family.error_threshold, 1 / (n * tolerance))
        sign = np.sign(family.rule_product)
        exact.contour(family.restitution, np.sqrt(family.position), sign, levels=[0], **JUMP)
        exact.set_title(label(n=n))
        draw_ratios(law, family, family.threshold_by_law, 1 / (n * tolerance))
        draw_differences(law, family)
        law.set_xlabel("restitution coefficient $r$")
    for row, name in zip(slots, ("exact", "error law"), strict=True):
        row[0].set_yticks(np.sqrt(POSITIONS), [f"{each:g}" for each in POSITIONS])
        row[0].set_ylim(0, 1)
        row[0].set_ylabel(f"{name}\n$\\Lambda$ from saddle-node (0)\nto period doubling (1)")
    percent = f"{100 * tolerance:g} %"
    quantity = TITLES["max_height"]
    words = rf"{quantity}: $\varpi$ from which on the error is within {percent}"
    figure.suptitle(words, fontsize="medium")
    entries = {
        r"rule of thumb, $\varpi = 1/(n\varepsilon)$": sample(linewidth=RULE["linewidths"]),
        r"a larger $\varpi$ is needed": Patch(facecolor=FAILS),
        "the error changes its sign": sample(linewidth=1.0, linestyle=JUMP["linestyles"][0]),
        r"orbit not stable at this $\varpi$": Patch(**ABSENT),
        f"the law differs by more than {100 * float(data.law_differs_above):g} %": Patch(**DIFFERS),
    }
    legend_below(figure, entries, columns=3)
    return figure


def draw_ratios(axes: Axes, family: xr.Dataset, needed: xr.DataArray, rule: float) -> None:
    """Contours of a ϖ, of each sign of the error for itself, and where the rule of thumb fails."""
    places = family.restitution, np.sqrt(family.position)
    axes.contourf(*places, needed, levels=[0, rule, np.inf], colors=["white", FAILS])
    for sign, levels in LEVELS.items():
        of_sign = needed.where(np.sign(family.rule_product) == sign)
        if of_sign.notnull().any():
            lines = axes.contour(*places, of_sign, levels=levels, colors="black", linewidths=0.7)
            axes.clabel(lines, fontsize=6.5, fmt="%g", manual=[*label_points(lines)])
    axes.contour(*places, needed, levels=[rule], **RULE)


def label_points(lines: ContourSet) -> Iterator[np.ndarray]:
    """A point on the longest line of each level, away from the edges and from its neighbours."""
    longest = [max(of_level, key=len, default=np.empty(0)) for of_level in lines.allsegs]
    for share, line in zip(cycle((0.4, 0.65)), filter(len, longest), strict=False):
        height = line[:, 1]
        wanted = height.min() + share * np.ptp(height)
        yield line[np.argmin(np.abs(height - wanted))]


def draw_differences(axes: Axes, family: xr.Dataset) -> None:
    """Dots where the ϖ by the error law differs from the exact one by more than a share."""
    apart = np.abs(family.threshold_by_law / family.error_threshold - 1)
    differs = apart > family.law_differs_above
    places = family.restitution, np.sqrt(family.position)
    dots = axes.contourf(*places, differs, levels=[0.5, 2], colors="none", hatches=["...."])
    dots.set(edgecolor=DIFFERS["edgecolor"], linewidth=0)


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
    figure, found = panels_by_quantity(data, 4.8)
    given = parameters(data)
    ratio = data.centroid_ratio.values
    per_cycle = 2 * given["n"]
    share = 1 / (per_cycle * ratio)
    for quantity, axes in found.items():
        for law, model in np.ndindex(data.sizes["law"], data.sizes["model"]):
            one = data.isel(law=law, model=model).sel(quantity=quantity)
            known = one.relative_error.notnull().values
            size = one.relative_error.values[known]
            place, error = with_zero(ratio[known], size, float(one.law_error_zero))
            axes.plot(1 / (per_cycle * place), error, linewidth=1.0, **LAWS[str(one.law.values)])
        for slope in (1, 2):
            axes.plot(share, share**slope, **GUIDE)
        axes.set(xscale="log", xlabel=r"share of the cycle, $(D+\kappa)/(2\pi n)$")
        axes.label_outer()
    # The line of an error leaves the panels at its zero.
    least = float(data.relative_error.min())
    figure.axes[0].set_ylim(0.3 * least, max(1.0, float(data.relative_error.max())))
    spare = figure.axes[len(found)]
    spare.axis("off")
    # The panel above it has the numbers and the name of the axis.
    figure.axes[2].xaxis.set_tick_params(labelbottom=True)
    figure.axes[2].set_xlabel(figure.axes[3].get_xlabel())
    lines = [sample(linewidth=1.0, **LAWS[law]) for law in data["law"].values]
    names = [LAW_NAMES[law] for law in data["law"].values]
    about = (
        "upper five: restitution model\nlower five: corrected model\ndotted: slopes 1 and 2\n"
        + title(data, "n", "restitution", "amplitude")
    )
    spare.legend(lines, names, loc="center left", title=about, alignment="left")
    return figure


FIGURES: Mapping[str, Callable[[xr.Dataset], Figure]] = {
    "ext_impact": ext_impact,
    "ext_instant": ext_instant,
    "ext_orders": ext_orders,
    "ext_map": ext_map,
    "ext_laws": ext_laws,
}


def draw(name: str, data: xr.Dataset) -> Figure:
    """A figure by name from its dataset, in the style of the replication."""
    with style():
        return FIGURES[name](data)

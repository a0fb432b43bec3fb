"""The restitution that engines have beside the one asked for (bounces, bounce_settings)."""

import csv
from collections.abc import Iterable

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.datasets.selection import each
from bouncing_ball_beyond.inherited.drawing.canvas import WIDE, canvas, legend_below
from bouncing_ball_beyond.inherited.drawing.tables import (
    Columns,
    TextTable,
    text,
    text_table,
    to_markdown,
    value,
)

_MARKERS = "os^xD+v*<1"
# Bars beyond this range are cut off; the table has them.
_RANGE = (-0.2, 0.2)


def bounces(data: xr.Dataset) -> Figure:
    """Draw the r that engines have minus the one asked for, against r.

    There is a column for each time step and a row for each height of the drop. A bar spans the
    instants within a step at which a ball meets the ground.
    """
    steps = data.sizes["time_step"]
    rows = data.sizes["drop_height"]
    figure, slots = canvas(
        WIDE, 1.0 + 1.9 * rows, rows=rows, columns=steps, sharex=True, sharey=True
    )
    many = data.sizes["engine"]
    for row, at_height in zip(slots, each(data, "drop_height"), strict=True):
        for axes, part in zip(row, each(at_height, "time_step"), strict=True):
            axes.axhline(0.0, color="black", linewidth=0.6)
            for k, one in enumerate(each(part, "engine")):
                mean = one.got_mean - one.asked
                low = one.got_mean - one.got_least
                high = one.got_most - one.got_mean
                aside = one.asked + 0.012 * (k - (many - 1) / 2)
                axes.errorbar(
                    aside, mean, yerr=[low, high], fmt=_MARKERS[k], color=f"C{k}",
                    markersize=3.5, markerfacecolor="none", elinewidth=0.8,
                    label=str(one.engine.item()).replace("_", ", "),
                )  # fmt: skip
            step = 1 / part.time_step.item()
            axes.set(title=f"step 1/{step:.0f} s, drop {part.drop_height.item():g} m", ylim=_RANGE)
    for axes in slots[-1]:
        axes.set(xlabel="$r$ asked for")
    for row in slots:
        row[0].set(ylabel="$r$ got minus $r$ asked for")
    legend_below(figure, ncols=many // 2)
    return figure


def bounces_table(data: xr.Dataset) -> TextTable:
    """The r that engines have, for each engine, step, drop and r asked for."""
    columns: Columns = {
        "engine": text("engine"),
        "time step in s": value("time_step", ".5f"),
        "drop in m": value("drop_height", "g"),
        "r asked for": value("asked", "g"),
        "mean": value("got_mean", ".4f"),
        "least": value("got_least", ".4f"),
        "greatest": value("got_most", ".4f"),
    }
    return text_table(each(data, "engine", "time_step", "drop_height", "asked"), columns)


def settings(data: xr.Dataset) -> Figure:
    """Draw the r that engines have with other settings minus the one asked for.

    There is a row for each setting and a column for each height of the drop.
    """
    many = data.sizes["setting"]
    drops = data.sizes["drop_height"]
    figure, slots = canvas(WIDE, 1.0 + 0.17 * many, columns=drops, sharex=True, sharey=True)
    places = np.arange(many)
    for axes, at_height in zip(slots, each(data, "drop_height"), strict=True):
        axes.axvline(0.0, color="black", linewidth=0.6)
        for k, one in enumerate(each(at_height, "asked")):
            mean = one.got_mean - one.asked
            low = one.got_mean - one.got_least
            high = one.got_most - one.got_mean
            axes.errorbar(
                mean, places + 0.16 * (k - (data.sizes["asked"] - 1) / 2), xerr=[low, high],
                fmt=_MARKERS[k], color=f"C{k}", markersize=2.5, markerfacecolor="none",
                elinewidth=0.6, label=f"$r = {one.asked.item():g}$ asked for",
            )  # fmt: skip
        axes.set(
            title=f"drop {at_height.drop_height.item():g} m", xlim=_RANGE, ylim=(many - 0.4, -0.6),
            yticks=places, yticklabels=data.setting.values.tolist(),
        )  # fmt: skip
    slots[drops // 2].set(xlabel="$r$ got minus $r$ asked for")
    legend_below(figure)
    return figure


def settings_table(data: xr.Dataset) -> TextTable:
    """The r that engines have with other settings, for each drop and r asked for."""
    columns: Columns = {
        "engine and setting": text("setting"),
        "drop in m": value("drop_height", "g"),
        "r asked for": value("asked", "g"),
        "mean": value("got_mean", ".4f"),
        "least": value("got_least", ".4f"),
        "greatest": value("got_most", ".4f"),
    }
    return text_table(each(data, "setting", "drop_height", "asked"), columns)


def drivers(data: xr.Dataset) -> str:
    """The heights of the drivers beside the certified ones, as the table of a page."""
    columns: Columns = {
        "driver": lambda part: f"`{part.driver.item()}_driver.py`",
        "rule": lambda part: f"`{part.driver_rule.item()}`",
        "time step in ms": lambda part: f"{1000 * part.driver_step.item():.3g}",
        "measured": value("driver_height", ".4f"),
        "certified": value("driver_certified", ".4f"),
    }
    return to_markdown(*text_table(each(data, "driver"), columns))


def rapier_974(lines: Iterable[str]) -> str:
    """The parts of the height that Rapier recovers beside r², as the table of a page.

    Parameters
    ----------
    lines : iterable of str
        Those of docs/bounces/rapier_974.csv: the version, two settings, a column for each r, and
        where the numbers are from.
    """
    header, *rows = csv.reader(lines)
    squares = [f"{float(r) ** 2:.4f}" for r in header[3:-1]]
    asked = [f"r = {r}" for r in header[3:-1]]
    shown = [*header[:3], *asked, header[-1]]
    return to_markdown(shown, [["r²", "", "", *squares, ""], *rows])


def in_javascript(lines: Iterable[str]) -> str:
    """The mean r that engines for JavaScript have, as the table of a page.

    Parameters
    ----------
    lines : iterable of str
        Those of docs/bounces/javascript.csv: a line for each r, which are next to each other.
    """
    rows = list(csv.DictReader(lines))
    asked = list(dict.fromkeys(row["r"] for row in rows))
    names = ("engine", "time step in s", "drop in m")
    found: dict[tuple[str, ...], list[str]] = {}
    for row in rows:
        found.setdefault(tuple(row[name] for name in names), []).append(row["mean"])
    header = [*names, *(f"r = {r}" for r in asked)]
    return to_markdown(header, [[*place, *means] for place, means in found.items()])

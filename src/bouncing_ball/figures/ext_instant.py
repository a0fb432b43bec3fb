"""Extension: the flights before and after a contact meet at the centroid of its force."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.figures.style import (
    COLOURS,
    CONTACT,
    GUIDE,
    TABLE,
    canvas,
    note,
    parameters,
)


def draw(data: xr.Dataset) -> Figure:
    """The ball, the table and the continued flights; below, the contact force."""
    figure, (top, below) = canvas(4.2, 3.6, rows=2, sharex=True, height_ratios=(2.2, 1.0))
    time, end = data.time.values, float(data.contact_duration)
    meeting = float(data.meeting_time)
    for name, colour in (("flight_before", COLOURS[2]), ("flight_after", COLOURS[3])):
        inside = (time >= 0) if name == "flight_before" else (time <= end)
        continued = inside & (time > -0.15 * end) & (time < 1.15 * end)
        top.plot(time[continued], data[name].values[continued], "--", color=colour, linewidth=1.1)
    touching = (time >= 0) & (time <= end)
    top.plot(time, data.table, color=TABLE, label="table")
    top.plot(time, data.ball, color=CONTACT, label="ball")
    top.plot(time[touching], data.ball.values[touching], color=CONTACT, linewidth=2.6)
    top.plot([], [], "--", color=COLOURS[2], label="flight before, continued")
    top.plot([], [], "--", color=COLOURS[3], label="flight after, continued")
    top.plot(meeting, float(data.meeting_height), "o", color="black", markersize=5, zorder=5)
    below.fill_between(
        time[touching], data.contact_force.values[touching], color=CONTACT, alpha=0.25, linewidth=0
    )
    below.plot(time[touching], data.contact_force.values[touching], color=CONTACT)
    below.axhline(0.0, color="black", linewidth=0.5)
    for axes in (top, below):
        axes.axvline(meeting, **GUIDE)
    note(below, "$t_c$", (meeting, 0), (3, 3), fontsize=9)
    low = float(data.meeting_height)
    high = float(data.table.values[touching].max())
    margin = high - low
    top.set(ylabel="height", ylim=(low - 0.12 * margin, high + 0.6 * margin))
    below.set(
        xlabel=r"time since the start of contact $\tau$",
        ylabel="contact force",
        xlim=(float(time[0]), float(time[-1])),
    )
    top.set_title(parameters(data, "n", "restitution", "amplitude", "frequency_ratio"), fontsize=9)
    figure.legend(*top.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure

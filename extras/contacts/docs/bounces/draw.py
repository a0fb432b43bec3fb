"""Draw docs/data/bounces.png and bounce_settings.png from the tables beside them."""

import csv
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of a backend without a window)

DATA = Path(__file__).resolve().parents[1] / "data"
MARKERS = "os^xD+v*<1"
# Bars beyond this range are cut off; the tables have them.
RANGE = (-0.2, 0.2)


def table(name):
    with (DATA / f"{name}.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def bar(axes, place, row, k, label, upright):
    asked = float(row["r asked for"])
    mean, low, high = (float(row[key]) for key in ("mean", "least", "greatest"))
    reach = [[mean - low], [high - mean]]
    where = (place, mean - asked) if upright else (mean - asked, place)
    axes.errorbar(
        *where,
        **{"yerr" if upright else "xerr": reach},
        fmt=MARKERS[k],
        color=f"C{k}",
        markersize=3,
        markerfacecolor="none",
        elinewidth=0.7,
        label=label,
    )


def bounces():
    rows = table("bounces")
    steps = sorted({row["time step in s"] for row in rows}, key=float)
    drops = sorted({row["drop in m"] for row in rows}, key=float)
    engines = sorted({row["engine"] for row in rows})
    figure, slots = plt.subplots(
        len(drops), len(steps), sharex=True, sharey=True, figsize=(11, 2 * len(drops) + 1)
    )
    for row in rows:
        k = engines.index(row["engine"])
        axes = slots[drops.index(row["drop in m"]), steps.index(row["time step in s"])]
        place = float(row["r asked for"]) + 0.012 * (k - (len(engines) - 1) / 2)
        bar(axes, place, row, k, row["engine"].replace("_", ", "), upright=True)
        step = 1 / float(row["time step in s"])
        axes.set(title=f"step 1/{step:.0f} s, drop {row['drop in m']} m", ylim=RANGE)
    finish(figure, slots, "r asked for", "r got minus r asked for", len(engines))
    figure.savefig(DATA / "bounces.png", dpi=100)


def settings():
    rows = table("bounce_settings")
    drops = sorted({row["drop in m"] for row in rows}, key=float)
    names = list(dict.fromkeys(row["engine and setting"] for row in rows))
    asked = sorted({row["r asked for"] for row in rows}, key=float)
    figure, slots = plt.subplots(
        1, len(drops), sharex=True, sharey=True, figsize=(11, 1 + 0.2 * len(names)), squeeze=False
    )
    for row in rows:
        k = asked.index(row["r asked for"])
        axes = slots[0, drops.index(row["drop in m"])]
        place = names.index(row["engine and setting"]) + 0.16 * (k - (len(asked) - 1) / 2)
        bar(axes, place, row, k, f"r = {row['r asked for']} asked for", upright=False)
        axes.set(title=f"drop {row['drop in m']} m", xlim=RANGE, ylim=(len(names) - 0.4, -0.6))
        axes.set_yticks(range(len(names)), names)
    finish(figure, slots, "r got minus r asked for", "", len(asked))
    figure.savefig(DATA / "bounce_settings.png", dpi=100)


def finish(figure, slots, below, aside, many):
    for axes in slots.flat:
        line = axes.axhline if aside else axes.axvline
        line(0.0, color="black", linewidth=0.6)
    for axes in slots[-1]:
        axes.set_xlabel(below)
    for row in slots:
        row[0].set_ylabel(aside)
    handles, labels = slots.flat[0].get_legend_handles_labels()
    of = dict(zip(labels, handles, strict=True))
    figure.legend(of.values(), of.keys(), loc="lower center", ncols=min(many, 5))
    figure.tight_layout(rect=(0, 0.05, 1, 1))


if __name__ == "__main__":
    bounces()
    settings()

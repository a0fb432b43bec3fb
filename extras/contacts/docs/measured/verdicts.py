"""What the published experiments say of contact laws: a table, and docs/data/measured.png."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from bouncing_ball_contacts import fit
from bouncing_ball_contacts.laws import LAWS
from bouncing_ball_contacts.tables import experiments

DATA = Path(__file__).resolve().parents[1] / "data"


def main():
    found = {name: fit(name, laws=True) for name in experiments()}
    print("| experiment | impacts | r, 95 % | at, m/s | " + " | ".join(LAWS) + " |")
    print("| --- | --- | --- | --- |" + " --- |" * len(LAWS))
    for name, one in found.items():
        words = {law.law: f"{law.verdict}, {law.needed:.4f}" for law in one.laws}
        low, high = one.interval
        cells = [f"`{name}`", str(len(one.impacts.speed)), f"{low:.4f} to {high:.4f}"]
        cells += [f"{one.speed:.3g}", *(words.get(law, "–") for law in LAWS)]
        print("| " + " | ".join(cells) + " |")
    draw({name: one for name, one in found.items() if one.laws})


def draw(found):
    figure = Figure(figsize=(11, 12))
    slots = figure.subplots(4, 3)
    for axes, (name, one) in zip(slots.flat, found.items(), strict=False):
        v = one.impacts.speed
        axes.plot(v, one.impacts.restitution, "ko", markersize=3)
        speeds = np.geomspace(v.min(), v.max(), 100)
        of = {law.law: law.parameter for law in one.laws}
        for (name_of_law, law), dashes in zip(LAWS.items(), ["-", "--", ":"], strict=True):
            r = np.exp(law.log_r(of[name_of_law], speeds))
            axes.plot(speeds, r, dashes, label=name_of_law)
        spread = np.ptp(one.impacts.restitution)
        middle = float(np.mean(one.impacts.restitution))
        axes.set(
            title=one.recording.head.get("title", name), ylim=(middle - spread, middle + spread)
        )
    for axes in slots.flat[len(found) :]:
        axes.set_axis_off()
    for axes in slots[-1]:
        axes.set_xlabel("impact speed in m/s")
    for axes in slots[:, 0]:
        axes.set_ylabel("restitution coefficient")
    handles, labels = slots.flat[0].get_legend_handles_labels()
    of = dict(zip(labels, handles, strict=True))
    figure.legend(of.values(), of.keys(), loc="lower right")
    figure.tight_layout()
    figure.savefig(DATA / "measured.png", dpi=100)


if __name__ == "__main__":
    main()

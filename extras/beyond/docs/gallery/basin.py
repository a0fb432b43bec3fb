"""A basin: which first impacts lead to which motion in the long run?"""

import matplotlib.pyplot as plt

import bouncing_ball_beyond as bb
from paper_replication.drawing import SETTINGS, legend_below, panels

plt.style.use(SETTINGS)

basins = bb.basins(bb.Rigid(0.85), amplitude=0.95, starts=120)
figure, axes = panels(3.6)
basins.destination.plot(ax=axes, add_colorbar=False, cmap="viridis")
colours = plt.get_cmap("viridis")
count = max(basins.sizes["motion"] - 1, 1)
for motion in basins.motion.values:
    one = basins.sel(motion=motion)
    label = one.kind.item()
    if one.impacts > 0:
        label += f": k = {one.impacts.item()}, m = {one.periods.item()}"
    axes.scatter([], [], color=colours(motion / count), label=label)
legend_below(figure)
axes.set(
    title="Λ = 0.95, r = 0.85: k impacts in m periods",
    xlabel="phase of the first impact",
    ylabel="closing speed of the first impact",
)
figure.savefig("basin.png")

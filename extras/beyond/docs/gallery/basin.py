"""A basin: which first impacts lead to which motion in the long run?"""

import matplotlib.pyplot as plt

import bouncing_ball_beyond as bb

found = bb.basins(bb.Rigid(0.85), amplitude=0.95, starts=120)
figure, axes = plt.subplots(layout="constrained")
found.destination.plot(ax=axes, add_colorbar=False, cmap="viridis")
colours = plt.get_cmap("viridis")
count = max(found.sizes["motion"] - 1, 1)
for motion in found.motion.values:
    one = found.sel(motion=motion)
    label = one.kind.item()
    if one.impacts > 0:
        label += f": k = {one.impacts.item()}, m = {one.periods.item()}"
    axes.scatter([], [], color=colours(motion / count), label=label)
figure.legend(loc="outside lower center", ncols=2)
axes.set_title("Λ = 0.95, r = 0.85: k impacts in m periods of the table")
figure.savefig("basin.png")

"""A basin: which first impacts lead to which motion in the long run?"""

import matplotlib.pyplot as plt
import numpy as np

import bouncing_ball_beyond as bb

found = bb.basins(bb.Rigid(0.85), amplitude=0.95, starts=120)
names, kinds = np.unique(found.in_words, return_inverse=True)
figure, axes = plt.subplots(layout="constrained")
mesh = axes.pcolormesh(found.phase, found.relative_velocity, kinds.reshape(found.kind.shape), cmap="viridis")
colours = [mesh.cmap(mesh.norm(number)) for number in range(len(names))]
axes.legend([plt.Rectangle((0, 0), 1, 1, color=each) for each in colours], names)
axes.set(xlabel="phase of the first impact", ylabel="relative velocity before it", title="Λ = 0.95, r = 0.85")
figure.savefig("basin.png")

"""The orbit diagram: the phases at which a ball lands in the long run, for each amplitude."""

import numpy as np

import bouncing_ball_beyond as bb

ball = bb.Rigid(0.7)
found = bb.orbit_diagram(ball, amplitude=np.linspace(0.4, 2.0, 200))
found.plot("orbit_diagram.png")

"""The orbit diagram: the phases at which a ball lands in the long run, for each amplitude."""

import numpy as np

import bouncing_ball_beyond

ball = bouncing_ball_beyond.rigid(restitution=0.7)
found = bouncing_ball_beyond.orbit_diagram(ball, amplitude=np.linspace(0.4, 2.0, 200))
found.plot("orbit_diagram.png")

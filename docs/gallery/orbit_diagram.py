"""The orbit diagram: the phases at which a ball lands in the long run, for each amplitude."""

import numpy as np

import bouncing_ball

found = bouncing_ball.orbit_diagram(np.linspace(0.4, 2.0, 200), restitution=0.7)
found.plot("orbit_diagram.png")

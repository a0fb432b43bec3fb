"""Heights on a table of 20 Hz and 0.8 g: MuJoCo's impedances against a spring and a damper."""

import numpy as np
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_contacts.engines.impedance import Impedance

MASS, TABLE, R, AMPLITUDE = 0.5, 2 * np.pi * 20, 0.75, 0.8  # kg, rad/s, r, acceleration in g
zeta = float(damping_ratio(R, Release.FORCE))
width = 0.001 * TABLE**2 / 9.80665  # 1 mm in units of g/Ω²

print("k in kN/m  d = 0.95  default")
for stiffness in (1e5, 1e6, 1e7):
    ratio = np.sqrt(stiffness / MASS) / TABLE
    spring = ContactModel(SpringDamper(ratio, zeta, Release.FORCE))
    heights = [n_t.require_orbit(spring, 1, AMPLITUDE).max_height]
    for least in (0.95, 0.9):
        law = ContactModel(Impedance(ratio, zeta, 0.95, least, width))
        heights.append(n_t.require_orbit(law, 1, AMPLITUDE).max_height)
    errors = (f"{height / heights[0] - 1:+.2%}" for height in heights[1:])
    print(f"{stiffness / 1000:<9g}  {'    '.join(errors)}")

"""MuJoCo's impedances, d = 0.95 and the default, against a spring and damper alike."""

import numpy as np

from bouncing_ball.accuracy.errors import relative
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.laws.impedance import Impedance
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits.corrected_model import CorrectedModel
from bouncing_ball.orbits.law_model import LawModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel

R, AMPLITUDE = 0.75, 0.8
zeta = float(damping_ratio(R, Release.FORCE))
width = 0.001 * (2 * np.pi * 20) ** 2 / 9.80665  # 1 mm on a table of 20 Hz

print("varpi  impedance    sigma/D  height  spring's error  corrected")
for ratio in (10.0, 20.0, 50.0):
    spring = SpringDamper(ratio, zeta, Release.FORCE)
    other = SpringDamperModel(spring).require_orbit(1, AMPLITUDE).max_height
    for name, least in (("0.95", 0.95), ("0.9 to 0.95", 0.9)):
        law = Impedance(ratio, zeta, 0.95, least, width)
        models = LawModel(law), CorrectedModel(Signature(law))
        orbit, corrected = (model.require_orbit(1, AMPLITUDE) for model in models)
        shares = Signature(law)(-orbit.relative_impact_velocity)
        numbers = float(shares.load / shares.duration), orbit.max_height
        errors = (f"{relative(orbit.max_height, x):>14.3%}" for x in (other, corrected.max_height))
        print(f"{ratio:<5g}  {name:<11}  {numbers[0]:.4f}   {numbers[1]:.4f}  ", *errors)

"""MuJoCo's default impedance, d = 0.95, against the spring and damper of the same numbers."""

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

print("varpi  sigma/D, spring  sigma/D, d = 0.95  height, d = 0.95  spring's error  corrected")
for ratio in (10.0, 20.0, 50.0):
    spring, law = SpringDamper(ratio, zeta, Release.FORCE), Impedance(ratio, zeta)
    shares = [float(x.signature.load / x.signature.duration) for x in (spring, law)]
    models = LawModel(law), SpringDamperModel(spring), CorrectedModel(Signature(law))
    exact, other, corrected = (float(m.require_orbit(1, AMPLITUDE).max_height) for m in models)
    errors = [other / exact - 1, corrected / exact - 1]
    print(f"{ratio:<5g}  {shares[0]:<15.4f}  {shares[1]:<17.4f}  {exact:<16.4f}", end="  ")
    print(f"{errors[0]:<14.3%}  {errors[1]:.4%}")

"""A DEM particle: the contact of two of them is not that of one with a wall."""

from math import pi

from bouncing_ball_contacts import Contact, Question, Table, assess_contact

# A tutorial of MercuryDPM (github.com/gladk/MercuryDPM, Drivers/Tutorials/Tutorial4.cpp) drops
# a ball of 5 mm and 2500 kg/m³ on a wall, with a spring and a damper computed for 5 ms and r =
# 0.88. Two such balls have half the mass.
mass = 2500 * 4 / 3 * pi * 5e-3**3
table = Table(frequency="10 Hz", acceleration="0.8 g")
for name, moving in (("two balls", mass / 2), ("ball and wall", mass)):
    contact = Contact(mass=moving, stiffness=259.0159, damping=0.0334)
    met = assess_contact(table, contact, Question(n=1))
    r = met.restitution["displacement"]
    print(f"{name}: {met.contact_time:.2g} s, r = {r:.2f}, step {met.time_step.largest:.2g} s")
one = met.judged
errors = one.errors["max_height"], one.corrected_errors["max_height"]
print(f"height: restitution model {errors[0]:+.1%}, corrected model {errors[1]:+.3%}")

# The grains of Silbert et al. (Phys. Rev. E 64, 051302, 2001), as LAMMPS' pair_style gran/hooke
# quotes them: k = 2·10⁵ and γ = 50 in units of mass, diameter and gravity; two grains have half
# the mass and half the damper. MercuryDPM's unit test (HelperFunctionsUnitTest.cpp) has
# 0.004971179385062563 and 0.883132984295725 for them.
grain = assess_contact(
    Table(frequency="1 rad/s", acceleration=1.0, gravity=1.0),
    Contact(mass=0.5, stiffness=2e5, damping=25.0),
    Question(n=1),
)
print(f"grains: {grain.contact_time:.15f}, {grain.restitution['displacement']:.14f}")

"""A steel ball of 1.58 mm on a shaker: a Hertz contact with a measured restitution."""

from math import pi, sqrt

from bouncing_ball_contacts import Contact, Table, assess_contact

# Steel of the rotor library ROSS (github.com/petrobras/ross, ross/materials.py).
density, young, shear = 7810.0, 211e9, 81.2e9
poisson = young / (2 * shear) - 1
radius = 0.79e-3
mass = density * 4 / 3 * pi * radius**3

# A small steel ball that is dropped from 50 cm on a steel plate falls silent after 30 s
# (problem 4.10 of Exercises for the Feynman Lectures on Physics, as quoted in solutions of it).
# Its flights are a geometric series.
falls = 30 / sqrt(2 * 0.5 / 9.81)
restitution = (falls - 1) / (falls + 1)

# Steel beads have been shaken with 25 to 100 Hz (Dorbolo, Ludewig and Vandewalle,
# arXiv:0808.2936, abstract).
steel = Contact(
    mass=mass,
    radius=radius,
    youngs_modulus=young,
    poissons_ratio=poisson,
    table_youngs_modulus=young,
    table_poissons_ratio=poisson,
    measured_restitution=restitution,
)
ball = assess_contact(Table(frequency="60 Hz", acceleration="0.5 g"), steel)
print(
    f"r = {restitution:.2f}, contact time {ball.contact_time:.1g} s, ϖ = {ball.frequency_ratio:.0f}"
)
one = ball.judged
errors = one.errors["max_height"], one.corrected_errors["max_height"]
print(f"height: restitution model {errors[0]:+.1%}, corrected model {errors[1]:+.3%}")

# On a thick steel plate such a ball was in contact for about 5 µs, measured (G. McLaskey,
# Cornell, courses.cit.cornell.edu/mclaskey/impact.html); at 1 m/s Hertz's formula gives nearly
# that.
modulus = young / (2 * (1 - poisson**2))
print(f"at 1 m/s {2.868 * (mass**2 / (radius * modulus**2)) ** 0.2:.2g} s")

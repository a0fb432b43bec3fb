"""An idle gear that the driving flank throws off and the drag brings back: a bouncing ball."""

from bouncing_ball_contacts import Contact, Question, Table, assess_contact, choose_contact

# Inertia, base radius, 16 teeth, mesh stiffness and a damping ratio of 0.05 of the pair of A.
# Kahraman and R. Singh (Journal of Sound and Vibration 146, 1991, 135–156), as quoted in
# Workflow_code.m of github.com/Fraunhofer-SCAI/mrDMD-damage-detection. There both gears move,
# with half the mass: 0.23 kg.
inertia, base, stiffness = 1.15e-3, 50e-3, 3.8e8
damping = 2 * 0.05 * (0.23 * stiffness) ** 0.5

# Along the line of action m = I/R², and the drag torque M (here 0.5 N m) takes the part of
# gravity, M R/I.
mass = inertia / base**2
drag = 0.5 * base / inertia
pair = assess_contact(
    Table(frequency=16 * 750 / 60, table_amplitude="10 um", gravity=drag),
    Contact(mass=mass, stiffness=stiffness, damping=damping),
    Question(n=1),
)
one = pair.judged
errors = one.errors["max_height"], one.corrected_errors["max_height"]
print(f"height: restitution model {errors[0]:+.1%}, corrected model {errors[1]:+.3%}")
orbit = pair.orbits[0]
worst = max(orbit.errors, key=lambda name: abs(orbit.errors[name]))
print(f"largest error: {worst}, {100 * orbit.errors[worst]:+.1f} %")

# Which mesh would do, for Λ = 1 and r = 0.65?
chosen = choose_contact(
    Table(frequency="200 Hz", acceleration=drag, gravity=drag),
    Contact(mass=mass, restitution=0.65),
)
print(f"enough: ϖ = {chosen.frequency_ratio:.2f}, {chosen.stiffness:.2g} N/m")

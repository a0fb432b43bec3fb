"""A rubber ball of r = 0.9 that stays in contact for 8.4 ms, whatever the height of its fall."""

from bouncing_ball_contacts import Contact, Question, Table, assess_contact

# Measured, within 1 ms: journals.azbuki.bg, "Measuring the collision time of a ball with high
# coefficient of restitution". A time that does not depend on the speed is that of a linear
# contact.
ball = assess_contact(
    Table(frequency="10 Hz", acceleration="0.6 g"),
    Contact(mass="47 g", contact_time="8.4 ms", measured_restitution=0.9),
    Question(n=1),
)
one = ball.judged
errors = one.errors["max_height"], one.corrected_errors["max_height"]
print(f"height: restitution model {errors[0]:+.1%}, corrected model {errors[1]:+.3%}")
delay = ball.corrected.delay
load = ball.corrected.load
r = ball.corrected.restitution
print(f"corrected: rebound {delay:.2g} s later, r = {r:.2g} + {load:.1g} s · a/v")

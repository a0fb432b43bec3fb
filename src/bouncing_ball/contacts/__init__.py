"""The models of the impact; this package knows nothing of periodic orbits.

Units and broadcasting are those of :mod:`bouncing_ball`. Contacts are described relative to the
table: δ = z - w is the displacement of the ball, p = -δ its penetration, and v > 0 the speed of
approach at the start of contact. Therefore δ′ < 0 and p′ > 0 at impact.
"""

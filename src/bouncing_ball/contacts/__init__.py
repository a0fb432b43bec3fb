"""The models of the impact, without anything about periodic orbits.

Units and broadcasting are those of :mod:`bouncing_ball`. Contacts are described relative to the
table: δ = z - w is the displacement of the ball, p = -δ its penetration, and v > 0 the speed of
approach at the start of contact. The signs follow from there: δ′ < 0 and p′ > 0 at impact.
"""

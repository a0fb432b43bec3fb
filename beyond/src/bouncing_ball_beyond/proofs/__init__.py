"""Proofs by ball arithmetic: intervals that contain the numbers that the paper prints.

The closed branch (:mod:`bouncing_ball_beyond.periodic.one_impact.spring_damper_branch`) reduces an
n-T orbit to one unknown. Here its equations are evaluated with balls, midpoints with an error
bound, of the library Arb, and derivatives are the coefficients of truncated Taylor series with
balls as coefficients. An interval Newton step that maps a ball into its own interior proves that
the ball contains exactly one solution. The equations themselves, and how they were read from the
paper, are not proved.
"""

from bouncing_ball_beyond.proofs.installed import proofs_extra

# Before the modules of this room need it one by one.
with proofs_extra():
    import flint as flint

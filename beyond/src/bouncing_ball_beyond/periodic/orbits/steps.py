"""The steps with which branches of orbits are followed, and those of Newton's method for orbits.

Steps of a branch are lengths of arc over its unknowns. Whole branches of n-T orbits, which are
those of the paper's figures, take theirs from the configuration
(:mod:`~bouncing_ball_beyond.periodic.one_impact.whole_branch`).
"""

from dataclasses import replace

from bouncing_ball_beyond.inherited.numerics.corrector import NewtonSettings
from bouncing_ball_beyond.inherited.numerics.steps import StepControl
from bouncing_ball_beyond.periodic.orbits.short_steps import ShortSteps

STEPS = StepControl(smallest=1e-9, largest=0.1, max_angle=0.15)
"""Steps of a branch, over the phases, the velocities and arsinh of the parameter. A branch ends
where its points accumulate, for example where its orbits merge with permanent contact."""

STEPS_OF_DECADES = replace(STEPS, largest=0.25)
"""Steps of a branch along a parameter that counts in decades, such as ϖ or a stiffness. A decade
takes 14 points, and not 26, because the orbits hardly change: the unknown ϖD of a linear contact
stays near π, so that points far ahead are predicted well."""

STEPS_OF_CURVES = replace(STEPS, creep=1e-3)
"""Steps of a curve in two parameters, which ends where its points accumulate, for example at a
release without speed, where the equations have no derivatives."""

STEPS_OF_SEARCHES = StepControl(initial=0.05, smallest=1e-3, largest=0.4, max_angle=0.25)
"""Steps of a branch on which special orbits are sought. They are long, because only the order of
these orbits is wanted, each of which is located."""

PATIENT = ShortSteps(0.3)
"""Newton's method from a guess that is not the last point of a branch."""

NEARBY = ShortSteps(0.01)
"""Newton's method from a guess that is nearer to its orbit than other orbits are."""

IN_ROUNDS = ShortSteps(0.5, max_iterations=5)
"""A round of Newton's method for many orbits at once, of which those that have converged are left
out of the next round. Next to a fold the first step may be long."""

EXTENDED = NewtonSettings(max_iterations=25)
"""Newton's method for a bifurcation, from that of a simpler model."""

BY_DIFFERENCES = NewtonSettings(tolerance=1e-9, max_iterations=20)
"""Newton's method for a zero of a central difference, whose rounding moves the last step by
1e-11."""

OF_A_ROUND = NewtonSettings(tolerance=1e-7)
"""Newton's method from the orbits of the round before, whose error after a step of this length is
its square."""

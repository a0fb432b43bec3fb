"""Pseudo-arclength continuation of the solutions of F(x, p) = 0.

Four parts that compose: a :class:`~bouncing_ball.continuation.problem.Problem`,
a corrector, a step control and events; :mod:`bouncing_ball.continuation.branch`
puts them together. Nothing here knows what the unknowns mean.

References: E. L. Allgower and K. Georg, *Numerical Continuation Methods*,
Springer 1990; W. Govaerts, *Numerical Methods for Bifurcations of Dynamical
Equilibria*, SIAM 2000.
"""

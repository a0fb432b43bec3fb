"""Pseudo-arclength continuation of the solutions of F(x, p) = 0.

The four parts are a :class:`~bouncing_ball.continuation.corrector.Problem`, a corrector, a step
control and events; :mod:`bouncing_ball.continuation.branch` combines them. This package does not
depend on the meaning of the unknowns. N is the number of equations, and a point y = (x, p) has
N + 1 entries, of which the last is the parameter.

References: E. L. Allgower and K. Georg, *Numerical Continuation Methods*,
Springer 1990; W. Govaerts, *Numerical Methods for Bifurcations of Dynamical
Equilibria*, SIAM 2000.
"""

"""Numerical methods, independent of the ball: rows of arrays, certified first zeros, continuation.

Pseudo-arclength continuation follows the solutions of F(x, p) = 0. Its parts are a
:class:`~bouncing_ball_beyond.inherited.numerics.corrector.Problem`, a corrector, the control of
steps (:mod:`~bouncing_ball_beyond.inherited.numerics.steps`) and events;
:mod:`bouncing_ball_beyond.inherited.numerics.pseudo_arclength` combines them, and its result is a
:class:`~bouncing_ball_beyond.inherited.numerics.branch.Branch`. N is the number of equations, and a
point y = (x, p) has N + 1 entries, of which the last is the parameter.

References: E. L. Allgower and K. Georg, *Numerical Continuation Methods*, Springer 1990; W.
Govaerts, *Numerical Methods for Bifurcations of Dynamical Equilibria*, SIAM 2000.
"""

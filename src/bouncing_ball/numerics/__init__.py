"""Numerical methods, independent of the ball: rows of arrays, certified first zeros, continuation.

There are two ways to follow a curve. Pseudo-arclength continuation follows the solutions of
F(x, p) = 0. Its parts are a :class:`~bouncing_ball.numerics.corrector.Problem`, a corrector, the
control of steps (:mod:`~bouncing_ball.numerics.steps`) and events;
:mod:`bouncing_ball.numerics.continuation` combines them, and its result is a
:class:`~bouncing_ball.numerics.branch.Branch`. N is the number of equations, and a point y = (x, p)
has N + 1 entries, of which the last is the parameter.

The second way is for a curve across which an answer changes from yes to no, while no known function
with derivatives vanishes on it. Newton's method cannot correct a point onto such a curve; a search
finds the point that has one given coordinate. It is followed from one such point to the next, by
:mod:`bouncing_ball.numerics.point_by_point`. Each point is a search, and events are not located, so
that a curve with equations is followed in the first way.

References: E. L. Allgower and K. Georg, *Numerical Continuation Methods*, Springer 1990; W.
Govaerts, *Numerical Methods for Bifurcations of Dynamical Equilibria*, SIAM 2000.
"""

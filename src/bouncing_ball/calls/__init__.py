"""The calls that most people need, each with the parameters of a model.

r alone is the restitution model, r and ϖ are a spring-damper contact with the damping of r by
Eq. 16, and a law is a contact of that law (:func:`bouncing_ball.calls.model.model`). The command
line has the same calls, with the options from their signatures.

A list or an array in place of a number is an axis of the answer, named after its parameter, so
that two of them make a grid; :class:`xarray.DataArray` that share an axis are taken in pairs. The
answer is then a labelled dataset, and so it is for a history, a drop, a branch and the calls
about the motion on which a ball ends: ``plot()`` of it is its figure, ``plot("name.png")`` writes
that.
"""

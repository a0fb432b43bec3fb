"""The calls that most people need, each with the parameters of a model.

With r alone the model is the restitution model. With r and ϖ it is a spring-damper contact whose
damping follows from r by Eq. 16, and with a law it is a contact of that law
(:func:`bouncing_ball.calls.balls.model`).
The options of the command line come from the signatures of these calls.

A list or an array in place of a number becomes an axis of the result, named after its parameter, so
that two arrays make a grid. Two :class:`xarray.DataArray` that share an axis are taken in pairs.
With an array the result is a labelled dataset. Histories, drops, branches and the motions on which
balls end are always datasets. ``plot()`` draws a dataset, and ``plot("name.png")`` writes the
figure to a file.
"""

"""The calls that most people need, each with the parameters of a model.

With r alone it is the restitution model, with r and ϖ a spring-damper contact whose damping follows
from r by Eq. 16, and with a law a contact of that law (:func:`bouncing_ball.calls.model.model`).
The options of the command line come from the signatures of these calls.

A list or an array in place of a number becomes an axis of the result, named after its parameter, so
that two of them make a grid; :class:`xarray.DataArray` that share an axis are taken in pairs. The
result is then a labelled dataset. Histories, drops, branches and the motions on which balls end are
always datasets. ``plot()`` draws a dataset, and ``plot("name.png")`` writes the figure to a file.
"""

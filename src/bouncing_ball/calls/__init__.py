"""The functions about periodic orbits that users call, each with a ball as its first argument.

:mod:`~bouncing_ball.calls.periodic` is about n-T orbits, and
:mod:`~bouncing_ball.calls.followed` follows any periodic orbit along any parameter.

A list or an array in place of a number becomes an axis of the result, named after its parameter, so
that two arrays make a grid. Two :class:`xarray.DataArray` that share an axis are taken in pairs.
With an array the result is a labelled dataset. ``orbit``, ``limits`` and ``permanent_contact``
return Python floats for a single ball; all other results are always datasets. ``plot()`` draws a
dataset, and ``plot("name.png")`` writes the figure to a file.
"""

"""The functions that users call, each with a ball as its first argument.

:mod:`~bouncing_ball.calls.balls` and :mod:`~bouncing_ball.calls.law_balls` make balls.
:mod:`~bouncing_ball.calls.periodic` is about their n-T orbits,
:mod:`~bouncing_ball.calls.followed` follows any periodic orbit along any parameter,
:mod:`~bouncing_ball.calls.over_time` follows them, :mod:`~bouncing_ball.calls.long_run` finds the
motions on which they end, and :mod:`~bouncing_ball.calls.thresholds` the ϖ above which a
rigid ball replaces a contact within a tolerance.

A list or an array in place of a number becomes an axis of the result, named after its parameter, so
that two arrays make a grid. Two :class:`xarray.DataArray` that share an axis are taken in pairs.
With an array the result is a labelled dataset. ``orbit``, ``limits`` and ``permanent_contact``
return Python floats for a single ball; all other results are always datasets. ``plot()`` draws a
dataset, and ``plot("name.png")`` writes the figure to a file.
"""

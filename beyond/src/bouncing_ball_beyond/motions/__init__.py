"""Balls over time, and the motions on which they end: repeating, locked or chaotic, with exponents.

``over_time`` follows balls from a first impact or from a height, over a given time. All others step
balls by the legs of :meth:`.Dynamics.legs`. ``destination`` follows balls until
their motions are known: ``followed`` has what is known of each ball so far, ``recurrence`` examines
its returns, ``lyapunov`` the growth of deviations, and ``motions`` has the results. ``grids`` lays
the motions out as labelled datasets, ``basins`` follows an even grid of first impacts, and
``motion_of`` has the functions that a user calls for all of them; ``orbit_of_motion`` gives the
periodic orbit on which a ball ends. ``contraction`` is the sum of both exponents.
"""

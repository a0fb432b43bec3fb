"""The motions on which balls end: repeating, locked or chaotic; their means, exponents, cascades.

``destination`` follows balls until their motions are known, ``motions`` has the results, and
``lyapunov`` the growth of deviations; ``grids`` lays the motions out as labelled datasets, and
``means`` averages over them. ``lift_off`` gives the locked orbits of the restitution model,
``period_doublings`` the cascades of the n-T orbits, and ``cascade_of_flights`` the orbits between
permanent contact and chattering.
"""

"""Motions that only the studies beyond the paper compute: cascades, and locked orbits.

``cascade_of_flights`` has the orbits between permanent contact and chattering, ``period_doublings``
the cascades of the n-T orbits, and ``lift_off`` the locked orbits of the restitution model, which
``many_digits`` follows where doubles do not hold their digits.
"""

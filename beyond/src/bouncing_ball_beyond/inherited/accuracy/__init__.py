"""How accurate the restitution model is for a contact with a spring and a damper (Eqs. 37, 38).

:mod:`.errors` has the relative errors of the quantities compared, and :mod:`.thresholds` the
frequency ratios from which on they are tolerable.
"""

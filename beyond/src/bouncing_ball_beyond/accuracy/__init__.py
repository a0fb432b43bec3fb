"""Errors of one model of the impact against another, and their thresholds (Eqs. 37-38).

Errors are signed, relative and thus dimensionless. :mod:`.errors` has the paper's error, relative
to the simple model, and the deviation, relative to the contact.
"""

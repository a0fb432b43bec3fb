"""Errors of one model of the impact against another, and their thresholds (Eqs. 37-38).

Errors are signed, relative and thus dimensionless.
"""

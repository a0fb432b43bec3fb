"""Errors of one model of the impact against another, and the contacts for which they are small.

Units and broadcasting are those of :mod:`bouncing_ball`. Errors are signed, relative and thus
dimensionless; arrays of them have a leading axis for each model and each quantity.
"""

"""Errors of a restitution coefficient, and whether it is good enough."""

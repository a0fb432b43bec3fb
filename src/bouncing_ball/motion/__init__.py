"""Event-driven simulation of every model, from any initial state.

Units are those of :mod:`bouncing_ball`. Arrays have one entry per ball. Relative means relative to
the table, δ = z - w, and phases are those of the table, reduced to [-π, π] at impacts.
"""

"""Event-driven simulation of every model, from any initial state.

Units are those of :mod:`bouncing_ball`. Arrays have one entry per ball. "Relative" means relative
to the table, δ = z - w. Phases are those of the table, and are reduced to [-π, π] at impacts.
"""

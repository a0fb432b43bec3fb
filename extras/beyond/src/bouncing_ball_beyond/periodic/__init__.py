"""Periodic orbits, their branches and their bifurcations."""

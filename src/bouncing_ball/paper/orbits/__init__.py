"""The n-T orbits of both models: closed branches, bifurcations, stability, continuation (Eqs. 6-8,
18-27).
"""

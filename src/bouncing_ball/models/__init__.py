"""Flight, landing and impact of both models, and the simulation from impact to impact (Eqs. 1-5, 9,
12-15).
"""

"""The contact of the paper: damping, release, the linear contact, permanent contact (Eqs. 10-16,
28-36).

Contacts are described relative to the table, δ = z - w, and know nothing of periodic orbits.
"""

"""The motions on which balls end, their classification, and cascades of period doublings.

All quantities are dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g.
"""

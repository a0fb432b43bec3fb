"""Names, symbols, units and files of the results.

Nothing here depends on the figures. All quantities are dimensionless: times Ωt, lengths Ω²y/g,
velocities Ωẏ/g; phases and angles are in radians.
"""

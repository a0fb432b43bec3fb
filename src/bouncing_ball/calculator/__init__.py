"""The calculator for an engineer's contact: SI units in, a verdict out.

Results are in SI units, except Λ, ϖ, ζ, r and relative errors, which are dimensionless.
"""

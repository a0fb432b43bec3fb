"""The calculator for an engineer's own contact: SI units in, a verdict out."""

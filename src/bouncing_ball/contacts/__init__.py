"""The calculator for an engineer's contact: SI units in, a verdict out."""

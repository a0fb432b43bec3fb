"""Common parts of all pictures and tables: style, canvas, labels, files. Nothing is computed here.

Sizes are in inches, and offsets of texts in points; where the axis labels say so, phases and
velocities are divided by π.
"""

"""The paper, whole, and nothing else; :mod:`bouncing_ball.beyond` is built on it.

============ ============================================ ==================================
The force release, at which the contact force vanishes, is a variant of the paper's release; it
costs one symbol, κ.
"""

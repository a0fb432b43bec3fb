"""The studies that go past the paper: exhibits and proofs of the paper's numbers.

Nothing in the library and nothing in :mod:`bouncing_ball.paper` imports it.
"""

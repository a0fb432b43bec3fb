"""Extensions of the paper: other contact laws, the corrected restitution model, the error law,
long motions, physics engines, a calculator and an atlas. Nothing in :mod:`bouncing_ball.paper`
imports it.
"""

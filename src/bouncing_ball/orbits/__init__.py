"""n-T periodic orbits: existence, stability, bifurcations and observables of every impact model.

An n-T orbit repeats after n periods of the table, that is after the dimensionless time 2πn,
with one impact in between. :mod:`~bouncing_ball.orbits.model` is the interface that all models
share and :mod:`~bouncing_ball.orbits.orbit` what follows from the flight alone; each model adds
a module with its equations, and a closed form of its branch where there is one.

Units and broadcasting are those of :mod:`bouncing_ball`: everything is dimensionless, and an
entry is NaN where there is no orbit.
"""

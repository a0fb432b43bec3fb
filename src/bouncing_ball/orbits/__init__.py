"""n-T periodic orbits: existence, stability, bifurcations and observables of every impact model.

An n-T orbit repeats after n periods of the table, that is after the dimensionless time 2πn, and
has one impact in this time. :mod:`~bouncing_ball.orbits.model` is the interface of all models.
:mod:`~bouncing_ball.orbits.orbit` holds the results that follow from the flight alone. Each
model adds a module with its equations, and the closed form of its branch where one exists.

Units and broadcasting are those of :mod:`bouncing_ball`: everything is dimensionless, and an
entry is NaN where there is no orbit.
"""

"""The corrected restitution model: an impact is an instant at the centroid of the contact force.

The numbers of such an impact are in :mod:`bouncing_ball.models.instant`. In the order of the
theory :mod:`.impact` is the restitution map with them, :mod:`.motion` simulates balls by it,
:mod:`.branch` has its n-T orbits in closed form, :mod:`.orbits` the model, and :mod:`.errors`
compares it and the restitution model with the spring-damper model.
"""

"""The corrected restitution model: an impact is an instant at the centroid of the contact force.

The numbers of such an impact are in :mod:`bouncing_ball_beyond.models.instant`. In the order of the
theory :mod:`.impact` is the restitution map with them, :mod:`.motion` simulates balls by it, and
:mod:`.model` is the model. Its n-T orbits are in closed form in
:mod:`bouncing_ball_beyond.periodic.one_impact.corrected_branch`, and
:mod:`bouncing_ball_beyond.accuracy.simple_models` compares it and the restitution model with the
spring-damper model.
"""

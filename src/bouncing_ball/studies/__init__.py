"""The stages of the pipeline: parameters in, described datasets out.

Each study is a pure function of the parameters of one artifact, as given
in the configuration, and of settings of the whole run, such as the release rule. It returns an
:class:`xarray.Dataset` whose variables and dimensions are those of
:mod:`bouncing_ball.datasets.variables`, which also gives their symbols and units: everything is
dimensionless, times Ωt, lengths Ω²y/g and velocities Ωẏ/g, and phases are in radians. The
docstring of a study names the dimensions; ϖ stands for the dimension ``frequency_ratio``.

All studies have the same arguments, of which each takes those that it needs:

``parameters``    those of the artifact, an object of the class that stands beside the study
``release``       the rule that ends a contact, :class:`~bouncing_ball.contacts.release.Release`
``continuation``  step lengths and limits of the continuation along a branch
``data``          the datasets of other stages that the study reads, by artifact
``found``         the arrays of all places, if shards have computed them; None to compute them here
``part``          selects the places of a shard along the last axis; by default all of them

A function with the argument ``part`` returns these arrays by name, with the places last.

Parameters are checked when they are made (:class:`pydantic.ValidationError`), so that a study
raises only the errors that its docstring names.
"""

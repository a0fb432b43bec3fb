"""The stages of the pipeline: parameters in, described datasets out.

Each study is a pure function of the parameters of one artifact, as given
in the configuration, and of settings of the whole run, such as the release rule. It returns an
:class:`xarray.Dataset` whose variables and dimensions are those of
:mod:`bouncing_ball.datasets.variables`, which also gives their symbols and units: everything is
dimensionless, times Ωt, lengths Ω²y/g and velocities Ωẏ/g, and phases are in radians. The
docstring of a study names the dimensions; ϖ stands for the dimension ``frequency_ratio``.

Parameters are checked when they are made (:class:`pydantic.ValidationError`), so that a study
raises only the errors that its docstring names.
"""

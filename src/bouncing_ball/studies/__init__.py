"""The stages of the pipeline: parameters in, described datasets out.

Each study is a pure function of the parameters of one figure, as they stand
in the configuration, and returns an :class:`xarray.Dataset` whose variables
are those of :mod:`bouncing_ball.datasets.variables`.
"""

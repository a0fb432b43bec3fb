"""Names, symbols, units and files of the results.

Nothing here depends on the figures. All quantities are dimensionless: times Ωt, lengths Ω²y/g,
velocities Ωẏ/g; phases and angles are in radians.
"""

SADDLE_NODE, PERIOD_DOUBLING = "saddle-node", "period doubling"
"""The names of the bifurcations in datasets, figures and texts."""

GRAZING_FLIGHT, GRAZING_RELEASE = "grazing of a flight", "grazing of a release"
"""The kinds of the special orbits beyond which there is another impact or another flight."""

CASE = "case"
"""The single axis of results before :meth:`.Grid.unfold` gives them the axes of the call."""

DRAWING = "drawing"
"""The attribute of a dataset with the function that draws it, ``module:function``."""

"""The names of the bifurcations in datasets, figures and texts."""

SADDLE_NODE, PERIOD_DOUBLING = "saddle-node", "period doubling"

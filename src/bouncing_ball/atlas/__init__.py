"""The atlas: how stiff a contact must be for each model to be accurate, for all orbits.

All quantities are dimensionless; ϖ stands for the dimension ``frequency_ratio`` of a dataset.
"""

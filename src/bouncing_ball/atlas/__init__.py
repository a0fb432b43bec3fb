"""The atlas: for all orbits, how stiff a contact must be for each simple model to be accurate.

All quantities are dimensionless; ϖ stands for the dimension ``frequency_ratio`` of a dataset.
"""

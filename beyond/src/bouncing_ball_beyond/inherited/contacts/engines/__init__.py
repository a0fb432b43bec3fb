"""Physics engines: k, c and m of a contact that is given by an engine's parameters.

All quantities are in SI units. The engines are not imported and need not be installed.
"""

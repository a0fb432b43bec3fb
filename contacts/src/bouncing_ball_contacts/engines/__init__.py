"""Physics engines: their contact parameters from k, c and m, and the impacts that result.

All quantities are in SI units. The engines are not imported and need not be installed.
"""

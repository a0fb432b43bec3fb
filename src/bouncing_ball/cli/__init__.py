"""The command line, ``bouncing-ball``: orbits, limits, simulations and designs, and artifacts."""

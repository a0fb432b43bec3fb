"""The command line, ``bouncing-ball``: one orbit, its limits, one simulation."""

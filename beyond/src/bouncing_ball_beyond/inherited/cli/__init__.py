"""The command line, ``bouncing-ball``."""

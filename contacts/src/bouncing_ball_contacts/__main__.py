"""``python -m bouncing_ball_contacts``: the same as ``bouncing-ball``."""

from bouncing_ball_beyond.inherited.cli.main import main

# Tools that read docstrings import this module, too.
if __name__ == "__main__":
    main()

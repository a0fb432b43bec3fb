"""Arrays with labels as arguments of calls: what their labels may say, and what is refused."""

from labels_of_arguments import LabelsOfArguments

import bouncing_ball_beyond.inherited as bb


class TestLabelsOfArguments(LabelsOfArguments):
    """The calls of the root."""

    bb = bb

"""Contact laws: what pushes the ball, one short module each."""

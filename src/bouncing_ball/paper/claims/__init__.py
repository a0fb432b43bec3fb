"""The claims of the paper: what is printed, a second computation of it, and the verdicts."""

"""Stage: random orbits and balls with which the explorer's page compares what it computes."""

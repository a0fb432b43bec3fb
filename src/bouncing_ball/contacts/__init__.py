"""The two models of the impact, and nothing about periodic orbits."""

"""Datasets and pictures of orbits and branches."""

"""The stages: each module has `STAGE`, the function of each of its datasets by name."""

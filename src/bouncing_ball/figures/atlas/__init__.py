"""The charts and tables of the atlas, from its summary."""

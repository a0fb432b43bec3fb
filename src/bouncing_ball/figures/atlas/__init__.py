"""The charts of the atlas and its tables, from its summary."""

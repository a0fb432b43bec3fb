"""The charts and tables of the atlas, made from the summary of the atlas."""

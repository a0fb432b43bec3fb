"""Datasets turned into figures, tables and the article; nothing is computed here.

A drawing is a function ``draw(dataset) -> Figure`` of the dataset that its study makes, whose
docstring names the variables; schematics take no dataset. ``workflow/artifacts.yaml`` says which
function draws which figure. Figures of one kind share a module.
Functions whose name begins with an underscore draw a part of a figure into given axes. Sizes are
in inches, offsets of texts in points; axes show phases and velocities over π where they say so.
A dataset without a variable that is drawn raises :class:`AttributeError` or :class:`KeyError`.
"""

"""Datasets turned into figures, tables and the article; nothing is computed here.

A drawing is a function ``draw(dataset) -> Figure`` of the dataset of a study; the docstring of the
study names the variables. Schematics take no dataset. ``workflow/rules/study.smk`` gives the
function that draws each figure. Figures of one kind share a module. Functions whose names begin
with an underscore draw a part of a figure into given axes. Sizes are in inches, and offsets of
texts in points; where the axis labels say so, phases and velocities are divided by π.
If a variable is missing, a drawing raises :class:`AttributeError` or :class:`KeyError`.
"""

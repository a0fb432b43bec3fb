"""The paper's figures, one module each: ``draw(dataset)`` returns a figure.

They read datasets and compute nothing but unit changes of an axis.
"""

"""The parts of the workflow that do not depend on the science: the configuration and its check,
jobs, provenance, the article, and the comparison of two runs. This package knows no balls.
"""

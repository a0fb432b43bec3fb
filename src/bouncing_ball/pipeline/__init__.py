"""What the Snakefile needs beside the science: the configuration and its check, jobs, provenance,
the article, and the comparison of two runs. This package knows no balls.
"""

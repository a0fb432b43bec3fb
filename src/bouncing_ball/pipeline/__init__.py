"""The Python side of the Snakefile: sources of a stage, and the adapter around a job. No
science.
"""

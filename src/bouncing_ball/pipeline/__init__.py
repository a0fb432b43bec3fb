"""What the Snakefile needs of Python: checks of the configuration, sources of
a stage, and the adapter around a job. No science."""

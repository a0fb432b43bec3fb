"""The Python side of the Snakefile, without science: source files of a stage, jobs, progress."""

"""The figures of the results of beyond's calls."""

"""The explorer: one page that computes orbits and follows balls in the browser, and checks itself
against the package.
"""

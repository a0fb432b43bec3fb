"""The explorer: one page that computes orbits in the browser, and checks itself against the
package.
"""

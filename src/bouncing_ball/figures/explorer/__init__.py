"""The explorer: one page that computes by itself, and checks itself against the package."""

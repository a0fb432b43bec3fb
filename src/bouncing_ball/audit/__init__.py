"""The paper under audit: its claims, its formulas, its table, and every orbit by three routes."""

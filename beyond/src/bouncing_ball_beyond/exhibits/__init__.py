"""The figures and tables beyond the paper: one module for each stage, its pictures beside it."""

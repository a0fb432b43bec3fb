"""Datasets turned into figures, tables and the article; nothing is computed here."""

"""What the stages of the workflow share: descriptions of variables, figures, tables and texts."""

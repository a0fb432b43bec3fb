"""Whether two folders of artifacts say the same: drifts, budgets, verdicts, reports."""

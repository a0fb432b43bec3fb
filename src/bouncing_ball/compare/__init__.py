"""Whether two folders of artifacts say the same: drifts, budgets, outcomes, reports."""

"""The atlas: how stiff a contact must be for each model to be right, everywhere."""

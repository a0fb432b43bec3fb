"""Contacts of any law: Hertzian contacts, impedances, and their computation by collocation."""

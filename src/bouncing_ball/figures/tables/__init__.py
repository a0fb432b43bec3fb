"""Tables of datasets as texts: ``rows`` defines each table, ``formats`` writes it."""

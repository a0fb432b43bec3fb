"""Tables of datasets as text: ``rows(dataset)`` gives header and rows."""

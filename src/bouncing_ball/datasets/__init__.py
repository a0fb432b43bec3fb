"""Names, symbols, units and files of the results; knows no figure."""

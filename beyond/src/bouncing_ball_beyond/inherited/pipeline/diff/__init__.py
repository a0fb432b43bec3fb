"""The comparison of results with the accepted record, and their acceptance."""

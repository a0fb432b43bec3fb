"""Whether two folders of artifacts say the same; copying one over the accepted record."""

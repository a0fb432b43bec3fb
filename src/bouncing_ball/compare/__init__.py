"""The comparison of two folders of artifacts, and copying one over the accepted record."""

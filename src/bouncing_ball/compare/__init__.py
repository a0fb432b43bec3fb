"""The comparison of two folders of artifacts, and copying results over the accepted record."""

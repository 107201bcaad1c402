"""Ways in for RGB-D pictures that others took: recordings, bags and cameras into checked frames."""

"""The tree into the best cut, and its words."""

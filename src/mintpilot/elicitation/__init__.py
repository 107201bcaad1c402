"""The tree into the best query, and its words."""

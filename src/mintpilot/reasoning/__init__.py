"""Gaps into the tree; metrics, belief, pruning, explanation."""

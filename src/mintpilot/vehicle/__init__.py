"""Real flight links."""

"""The mission: its state, its events, one step, and the loop around it."""

"""Map into plans with their cost and what they rely on; trajectories in time."""

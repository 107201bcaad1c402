"""Real flight links: an autopilot over MAVLink, flown from a process of its own."""

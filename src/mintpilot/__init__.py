"""MintPilot: a drone that asks instead of guessing."""

__version__ = "0.1.0"

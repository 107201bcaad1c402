"""Operators: the terminal, and a script that knows the truth."""

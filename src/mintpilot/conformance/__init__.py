"""Checks for plug-ins, ours or a stranger's."""

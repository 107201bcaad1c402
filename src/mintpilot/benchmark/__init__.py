"""Scenarios by strategies by seeds into records, tables and plots."""

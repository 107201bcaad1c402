"""Learned policies: values of actions, exact or learned; a planner that flies by them, and what they say of a gap."""

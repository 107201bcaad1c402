"""The composition root: names into concrete parts, missions into running loops."""

"""Independent oracles: they share nothing with the package but the nouns of its core."""

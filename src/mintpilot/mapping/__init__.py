"""Objects and depth into the semantic map; expert knowledge into a new map."""

"""Rules in time: formulas, patterns, automata, conflicts, and their truth along a flight (method, section 14)."""

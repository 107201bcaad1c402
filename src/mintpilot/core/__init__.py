"""The nouns and the ports. No algorithms, no input or output."""

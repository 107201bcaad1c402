"""Questions asked aloud and answers heard beside running rotors, offline (method, section 12)."""

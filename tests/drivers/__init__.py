"""What plays a part of a mission in tests: it calls what is shipped, the answer update above all, and never judges."""

"""A query's words: in the operator's language, by template; in English a model may better them, and is checked."""

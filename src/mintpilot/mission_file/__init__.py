"""Mission files: schema, reader and checks."""

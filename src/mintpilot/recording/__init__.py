"""Events into the run folder: the record, the report, the pictures."""

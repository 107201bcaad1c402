"""One file per method of asking."""

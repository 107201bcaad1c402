"""Instructions into tasks, free answers into replies; language models behind one port."""

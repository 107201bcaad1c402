"""The loop, whole, on one page; mission files."""

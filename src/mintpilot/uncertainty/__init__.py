"""Map and instruction into knowledge gaps."""

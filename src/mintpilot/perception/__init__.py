"""RGB-D frames into detected objects with attributes."""

"""Flight plans as ground stations write and read them: QGroundControl ``.plan``, ``QGC WPL 110``, GeoJSON."""

"""Independent high-precision reference for one strip: it follows a material point from event to event."""

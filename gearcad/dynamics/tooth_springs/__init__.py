"""Springs between single teeth, integrated from event to event."""

"""Pictures of one flight."""

"""Pictures and report of the study."""

"""Pictures and report of a campaign."""

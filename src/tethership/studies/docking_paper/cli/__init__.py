"""Commands of the study: `reproduce` and `identify`."""

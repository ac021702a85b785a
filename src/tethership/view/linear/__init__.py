"""Pictures of linear models: root loci and mode shapes."""

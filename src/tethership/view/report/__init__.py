"""Reports: pages of text, tables and figures in one file."""

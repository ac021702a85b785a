"""Identification of the paper's ship from its printed tables and spectra."""

"""Whole studies built on the library: each one brings its own data, figures, report and commands.

Nothing in the library imports them; their commands and public names reach it by entry points (`tethership.commands`,
`tethership.studies`), as those of any other package do.
"""

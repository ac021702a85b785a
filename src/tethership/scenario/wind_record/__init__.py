"""A measured wind's file: its columns, names, units, times and gaps, up to one record. Depends on: errors, xarray."""

from tethership.scenario.wind_record.record import Record, read_record

__all__ = ["Record", "read_record"]

"""Telemetry of runs: tables and MCAP files, written tick by tick."""

"""Commands without a bus: tables of pulse widths and ticks for files and firmware."""

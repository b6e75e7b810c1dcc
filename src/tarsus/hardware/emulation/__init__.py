"""Emulated servos and boards, at the level of bytes, with the faults that real ones have.

They run in memory, on a clock that only moves when something waits, or behind a pseudo-terminal that the driver opens
like a serial port.
"""

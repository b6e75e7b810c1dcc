"""Codecs: pure functions between bytes and values, one module for each protocol; no codec knows a port or a clock."""

"""Sensor suites: what a simulated robot measures, with noise, bias, delay and drop-outs."""

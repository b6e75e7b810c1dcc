"""Compliant statics: a robot whose joints are springs stands on feet with friction, and its past counts."""

"""Compliant statics: a robot with elastic joints stands on feet with friction, and its history matters."""

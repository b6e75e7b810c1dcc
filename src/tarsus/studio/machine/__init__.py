"""Real and emulated machines in the studio: a run that the view Drive drives, bring-up, pulses."""

"""Live runs: keyboard and gamepad with a deadman, supervision by the servos' state, emulated robots."""

"""Standing up from any joint angles, sitting down, folding, power-off."""

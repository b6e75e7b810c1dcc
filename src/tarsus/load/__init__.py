"""What the joints bear: forces on the feet, torques, servos."""

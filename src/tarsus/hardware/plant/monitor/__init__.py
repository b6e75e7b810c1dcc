"""What notices faults of servos, bus and supply: from answers, from motion, from what servos report."""

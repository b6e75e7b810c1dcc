"""Contact forces, joint torques and servo sizing."""

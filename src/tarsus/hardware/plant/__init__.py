"""The plant of a real robot: servos that execute joint angles, and what it does when something fails."""

"""The walk from one moment to the next: steps, footholds, swing trajectories, time scaling."""

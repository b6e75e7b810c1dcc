"""How far a plan is true in physics: traces of simulated robots, what they did, and the difference from the plan."""

"""Why nothing moves: a decision tree whose answers are measured."""

"""Stances: body pose and rest footholds, and the steps and twists that they allow, as functions of geometry."""

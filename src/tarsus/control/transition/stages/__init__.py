"""Stages of planning a stance transition: generators that yield where their work continues in the next tick."""

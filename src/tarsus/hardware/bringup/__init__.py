"""Bring-up of a machine: ids, directions, zeros and limits, one joint at a time, saved after every answer."""

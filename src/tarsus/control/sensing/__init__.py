"""What sensor readings are worth: validation, ground plane, foot forces."""

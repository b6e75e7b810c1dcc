"""What sensor readings tell: their validation, contacts and loads of the feet, lost way, stopped and failed joints."""

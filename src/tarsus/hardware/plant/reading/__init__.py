"""What comes in from servos and sensors: positions, telemetry, contacts, attitude."""

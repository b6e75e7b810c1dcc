"""What the feet do on uneven ground: early contact, ground search, hole recovery."""

"""The body's pose while it walks: filtering, levelling, compliance of the feet."""

"""Body pose while walking: filtering, levelling, compliance of the feet."""

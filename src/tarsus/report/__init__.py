"""What is shown of it: tables, files, pictures."""

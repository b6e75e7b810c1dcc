"""Tables, files and figures of results."""

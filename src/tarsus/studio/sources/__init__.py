"""The equations of the five source documents, with live values."""

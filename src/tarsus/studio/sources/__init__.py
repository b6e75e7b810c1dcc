"""The five source documents' equations, with live numbers in them."""

"""The studio: an interactive web app. Sessions are independent of the transport; a server runs them.

Needs the extra ``studio``; `tarsus.studio.session` alone needs only the package itself.
"""

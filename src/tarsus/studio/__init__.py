"""The studio: the robot in the browser, live. A session without any transport, and a server around it.

Needs the extra ``studio``; `tarsus.studio.session` alone needs only the package itself.
"""

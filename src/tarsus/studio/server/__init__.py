"""The server of the sessions: FastAPI, one WebSocket per visitor. Needs the extra ``studio``."""

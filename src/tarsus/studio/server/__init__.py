"""The server around the sessions: FastAPI, one WebSocket a visitor. Needs the extra ``studio``."""

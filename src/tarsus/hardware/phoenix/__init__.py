"""Configuration headers of the Phoenix firmware, `Hex_Cfg.h`: reading and writing."""

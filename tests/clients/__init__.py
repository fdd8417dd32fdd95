"""Modbus clients in JavaScript."""

"""Benchmarks: what runs how fast, beside the limits of the machine and the peers of the field."""

"""Studies: scenes x methods x parameter values, measured against the truth, kept as records."""

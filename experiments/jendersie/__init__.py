"""Jendersie et al. 2016: precomputed illuminance composition. Figures and tables from records."""

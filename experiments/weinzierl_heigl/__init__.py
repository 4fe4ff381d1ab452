"""Weinzierl-Heigl 2013: virtual area lights. Figures and tables from records."""

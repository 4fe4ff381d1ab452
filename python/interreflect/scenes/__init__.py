"""Scenes: the built-in ones, and the values that every scene is made of."""

"""The live view: a page in which one flies through a scene, chooses a method, turns its knobs and compares with the truth."""

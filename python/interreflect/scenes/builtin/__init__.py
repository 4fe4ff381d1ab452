"""Built-in scenes, one file each: geometry, materials and lights made in code from a few knobs, the same bits every time."""

"""Rehfeld, Zirr and Dachsbacher 2014, "Clustered pre-convolved radiance caching": what it claims about voxels and cones."""

"""Freed 2018, "Tessellated voxelization for global illumination using voxel cone tracing": its tables and figures, one file each."""

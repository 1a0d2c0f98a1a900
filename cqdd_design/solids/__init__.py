"""The machine as solids: layout, parts, assembly, meshes, mass and interference."""

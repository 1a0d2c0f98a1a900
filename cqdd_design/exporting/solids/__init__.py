"""The machine as solids and meshes, and its bill of materials."""

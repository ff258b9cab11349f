"""glTF files (GLB, GLTF)."""

//! What is wrong with a mesh: open and non-manifold edges, degenerate and duplicate triangles.

//! What is culled must not matter: hulls, rectangles and reaches against points that are seen, lit
//! and shadowed.

mod bodies;
mod lights;
mod screen;
mod shadows;
mod views;

//! Shadow volumes made of what `umbrage_core::silhouette` finds, for any triangles: that they are
//! closed, and that counting their surfaces gives the shadow that rays find.

mod closed;
mod counts;
mod crossing;
mod shapes;
mod volume;

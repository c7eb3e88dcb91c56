//! Low-discrepancy points, and points of every light shape.

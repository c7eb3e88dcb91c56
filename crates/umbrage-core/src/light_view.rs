//! Light-space fits: the views that a map technique renders.

//! Procedural scenes with a registry.

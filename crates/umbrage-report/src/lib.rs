//! Runs scenes, techniques and lights against the ground truth; records, tables, JSON, CSV and HTML.

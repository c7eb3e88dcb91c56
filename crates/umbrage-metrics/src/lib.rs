//! How far a picture is from the truth: image errors and shadow errors.

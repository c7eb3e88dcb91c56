//! Ray-traced ground truth: the visibility of every kind of light on the CPU.
